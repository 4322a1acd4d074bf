// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <taut/mesh_files/pc2.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/temporary_file.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::pc2_test {

namespace {

// A reader after the published layout of the format, sharing nothing with the writer: numbers are
// put together by arithmetic, from bytes of increasing weight.

std::uint32_t integer(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = 256 * value + static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// An IEEE single by its definition: (−1)^s · 1.f · 2^(e − 127).
double real(const std::string& bytes, std::size_t at) {
    const std::uint32_t bits = integer(bytes, at);
    const double sign = bits >> 31 ? -1 : 1;
    const auto exponent = static_cast<int>((bits >> 23) & 255);
    const double fraction = static_cast<double>(bits & 0x7fffff) / 8388608;
    if (exponent == 0) return sign * std::ldexp(fraction, -126);
    return sign * std::ldexp(1 + fraction, exponent - 127);
}

struct Cache {
    bool understood = false;
    Index points = 0;
    double start = 0, sampling = 0;
    std::vector<taut::Points<double, 3>> frames;
};

Cache read(const TemporaryFile& file) {
    const std::string bytes = file.bytes();
    Cache cache;
    if (bytes.size() < 32 || bytes.substr(0, 12) != std::string("POINTCACHE2\0", 12)) return cache;
    cache.points = integer(bytes, 16);
    cache.start = real(bytes, 20);
    cache.sampling = real(bytes, 24);
    const std::size_t frames = integer(bytes, 28);
    const auto size = static_cast<std::size_t>(12 * cache.points);
    cache.understood = integer(bytes, 12) == 1 && bytes.size() == 32 + frames * size;
    for (std::size_t f = 0; cache.understood && f < frames; ++f) {
        auto& x = cache.frames.emplace_back(3, cache.points);
        for (Index i = 0; i < x.size(); ++i) {
            x(i % 3, i / 3) = real(bytes, 32 + f * size + 4 * static_cast<std::size_t>(i));
        }
    }
    return cache;
}

}  // namespace

TEMPLATE_TEST_CASE("pc2: every frame is read back to the bit of a float", "[io]", (Case<float, 1>),
                   (Case<float, 3>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    const TemporaryFile file("round_trip_" + std::to_string(sizeof(Scalar)) + std::to_string(Dim) +
                             ".pc2");
    Random random(1);
    std::vector<taut::Points<Scalar, Dim>> frames;
    taut::Pc2Writer cache(file.path, 7, {12.5F, 2});
    for (int f = 0; f < 5; ++f) {
        frames.push_back(random.points<Scalar, Dim>(7, -100, 100));
        frames.back()(0, 1) = static_cast<Scalar>(1e-41F);  // denormal
        frames.back()(0, 2) = -std::numeric_limits<float>::max();
        REQUIRE(cache.write(frames.back()));
    }
    CHECK(cache.frames() == 5);
    REQUIRE(cache.close());
    const auto found = read(file);
    REQUIRE(found.understood);
    CHECK(found.points == 7);
    CHECK(found.start == 12.5);
    CHECK(found.sampling == 2);
    REQUIRE(found.frames.size() == 5);
    for (std::size_t f = 0; f < 5; ++f) {
        taut::Points<double, 3> expected = taut::Points<double, 3>::Zero(3, 7);
        expected.topRows(Dim) = frames[f].template cast<float>().template cast<double>();
        CHECK(found.frames[f] == expected);
    }
}

TEST_CASE("pc2: a run cut short leaves a cache of the frames it had", "[io]") {
    const TemporaryFile file("cut_short.pc2");
    Random random(2);
    taut::Pc2Writer cache(file.path, 3);
    for (std::size_t f = 0; f < 4; ++f) {
        const auto found = read(file);
        CHECK(found.frames.size() == f);
        CHECK(found.understood == (f > 0));  // the header goes out with the first frame
        REQUIRE(cache.write(random.points<double, 3>(3, -1, 1)));
    }
    CHECK(read(file).frames.size() == 4);
}

TEST_CASE("pc2: bad input: a frame that is not finite is named and leaves the cache", "[io]") {
    const TemporaryFile file("not_finite.pc2");
    Random random(3);
    taut::Points<double, 3> x = random.points<double, 3>(4, -1, 1);
    taut::Pc2Writer cache(file.path, 4);
    REQUIRE(cache.write(x));
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e39}) {
        x(2, 3) = bad;
        const auto report = cache.write(x);
        CHECK(report.status == taut::FileStatus::not_finite);
        CHECK(report.where == 3);
        CHECK_THAT(report.message(),
                   ContainsSubstring(file.path) && ContainsSubstring("particle 3"));
    }
    CHECK(cache.frames() == 1);
    REQUIRE(cache.close());
    CHECK(read(file).frames.size() == 1);
    x(2, 3) = 0;
    CHECK_FALSE(cache.write(x));  // closed
}

TEST_CASE("pc2: bad input: wrong sizes and options are named", "[io][bad_input]") {
    const TemporaryFile file("refused.pc2");
    std::ofstream(file.path) << "an older cache";
    const auto zeros = [](Index n) -> taut::Points<double, 3> {
        return taut::Points<double, 3>::Zero(3, n);
    };
    CHECK_THAT(message_of([&] { taut::Pc2Writer(file.path, 0); }),
               ContainsSubstring("points is 0"));
    CHECK_THAT(message_of([&] { taut::Pc2Writer(file.path, Index(1) << 31); }),
               ContainsSubstring("points is 2147483648"));
    CHECK_THAT(message_of([&] {
                   taut::Pc2Writer(file.path, 1, {0, 0});
               }),
               ContainsSubstring("sampling is 0"));
    CHECK_THAT(message_of([&] {
                   taut::Pc2Writer(file.path, 1, {std::nanf(""), 1});
               }),
               ContainsSubstring("start is"));
    CHECK(file.bytes() == "an older cache");
    CHECK_THAT(message_of([&] {
                   taut::Pc2Writer cache(file.path, 2);
                   (void)cache.write(zeros(3));
               }),
               ContainsSubstring("3 positions; the cache has 2 points"));
    taut::Pc2Writer nowhere("no_such_directory/cache.pc2", 2);
    CHECK(nowhere.write(zeros(2)).status == taut::FileStatus::not_opened);
    CHECK_THAT(nowhere.close().message(), ContainsSubstring("no_such_directory/cache.pc2: cannot"));
}

#ifdef __linux__
TEST_CASE("pc2: bad input: a full disk is noticed at the frame it meets", "[io][bad_input]") {
    if (!std::ifstream("/dev/full")) return;
    taut::Pc2Writer cache("/dev/full", 2);
    const taut::Points<double, 3> x = taut::Points<double, 3>::Zero(3, 2);
    CHECK(cache.write(x).status == taut::FileStatus::not_written);
    CHECK(cache.frames() == 0);
}
#endif

}  // namespace taut_test::pc2_test
