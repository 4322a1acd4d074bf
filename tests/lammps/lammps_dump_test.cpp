// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/temporary_file.hpp"
#include "lammps_scenes.hpp"

namespace taut_test::lammps_dump_test {

using taut::DumpStatus;

namespace {

std::string exact(double number) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", number);
    return text;
}

struct Layout {
    bool sorted = true;
    bool velocities = true;
    bool units = true;
    bool extra = false;      // columns that nobody asked for, others in another order, blanks
    bool unwrapped = false;  // xu for x
};

/// A frame as LAMMPS 2022-01 writes it by dump custom.
std::string frame(const AnyState& state, const Layout& layout, Random& random) {
    const Index n = state.x.cols();
    const std::string u = layout.unwrapped ? "u" : "";
    const auto axes = [](const std::string& before, const std::string& after) {
        return " " + before + "x" + after + " " + before + "y" + after + " " + before + "z" + after;
    };
    std::string text;
    if (layout.units) text += "ITEM: UNITS\nsi\n";
    text += "ITEM: TIME\n" + exact(state.time) + "\nITEM: TIMESTEP\n100\n";
    text += "ITEM: NUMBER OF ATOMS\n" + std::to_string(n) + "\nITEM: BOX BOUNDS ss ss ss\n";
    for (int d = 0; d < 3; ++d) text += "-1.0e+00 1.0e+00\n";
    const std::string v = layout.velocities ? axes("v", "") : "";
    text += layout.extra ? "ITEM: ATOMS type" + v + " id" + axes("", u) + " mol \n"
                         : "ITEM: ATOMS id" + axes("", u) + v + " \n";
    std::vector<Index> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    for (Index i = n - 1; !layout.sorted && i > 0; --i) {
        std::swap(order[static_cast<std::size_t>(i)],
                  order[static_cast<std::size_t>(random.below(i + 1))]);
    }
    for (const Index i : order) {
        const auto triple = [&](const Eigen::MatrixXd& values) {
            std::string three;
            for (Index d = 0; d < 3; ++d) {
                three += " " + exact(d < values.rows() ? values(d, i) : 0);
            }
            return three;
        };
        const std::string id = std::to_string(i + 1);
        const std::string speed = layout.velocities ? triple(state.v) : "";
        text += layout.extra ? "1" + speed + " " + id + triple(state.x) + " 1 \n"
                             : id + triple(state.x) + speed + " \n";
    }
    return text;
}

AnyState random_frame(Random& random, const Kind& kind, Index n, double time) {
    AnyState state;
    state.x = random_points(random, kind.dim, n, -2, 2);
    state.v = random_points(random, kind.dim, n, -2, 2);
    state.x /= 3;  // numbers that need all their digits
    if (kind.single) state.x = state.x.cast<float>().cast<double>().eval();
    state.time = Scene(kind).rounded(time / 3);
    return state;
}

void put(const TemporaryFile& file, const std::string& text) {
    file.write(text.data(), text.size());
}

}  // namespace

TEST_CASE("lammps_dump: frames are read back to the bit, in any layout", "[io]") {
    const TemporaryFile file("layout.dump");
    Random random(1);
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (int bits = 0; bits < 32; ++bits) {
            CAPTURE(kind, bits);
            const Layout layout{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0,
                                (bits & 16) != 0};
            std::vector<AnyState> frames;
            std::string text;
            for (int f = 0; f < 3; ++f) {
                frames.push_back(random_frame(random, kind, 6, f));
                text += frame(frames.back(), layout, random);
                if (!layout.velocities) frames.back().v.setZero();
            }
            if (layout.extra) {
                for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 3) {
                    text.insert(at, " \t");
                }
            }
            put(file, text);
            const auto dump = open_dump(kind, file.path, 6);
            AnyState state;
            for (const AnyState& expected : frames) {
                REQUIRE(dump->read(state));
                CHECK(state == expected);
                CHECK(dump->has_velocities() == layout.velocities);
            }
            CHECK(dump->read(state).status == DumpStatus::end);
            CHECK(dump->read(state).status == DumpStatus::end);
            CHECK(dump->frames() == 3);
            CHECK(state == frames.back());
        }
    }
}

TEST_CASE("lammps_dump: a file cut anywhere gives whole frames and then says so",
          "[io][bad_input]") {
    const TemporaryFile file("cut.dump");
    Random random(2);
    const AnyState first = random_frame(random, {}, 4, 0), second = random_frame(random, {}, 4, 1);
    const std::string one = frame(first, {}, random);
    const std::string all = one + frame(second, {}, random);
    for (std::size_t size = 0; size < all.size(); ++size) {
        put(file, all.substr(0, size));
        const auto dump = open_dump({}, file.path, 4);
        AnyState state = second;
        state.time = -1;
        Index frames = 0;
        while (dump->read(state)) ++frames;
        CAPTURE(size);
        REQUIRE(frames == (size >= one.size() ? 1 : 0));
        REQUIRE(dump->read(state).status ==
                (size == one.size() ? DumpStatus::end : DumpStatus::cut));
        // What was not read as a whole has changed nothing.
        REQUIRE(state.x == (frames > 0 ? first.x : second.x));
        REQUIRE(state.time == (frames > 0 ? first.time : -1));
    }
}

TEST_CASE("lammps_dump: a last line of any length that has no end is cut", "[io][bad_input]") {
    const TemporaryFile file("tail.dump");
    Random random(4);
    const std::string one = frame(random_frame(random, {}, 4, 0), {}, random);
    for (std::size_t length = 1; length < 1100; ++length) {
        put(file, one + std::string(length, 'x'));
        const auto dump = open_dump({}, file.path, 4);
        AnyState state;
        REQUIRE(dump->read(state));
        CAPTURE(length);
        REQUIRE(dump->read(state).status == DumpStatus::cut);
    }
}

TEST_CASE("lammps_dump: bad input: foreign lines are named", "[io][bad_input]") {
    const TemporaryFile file("foreign.dump");
    Random random(3);
    const Kind flat{false, 2};
    const std::string good = frame(random_frame(random, flat, 3, 0), {}, random);
    const auto refused = [&](const std::string& text, DumpStatus status, long long line,
                             std::initializer_list<const char*> words) {
        put(file, text);
        const auto dump = open_dump(flat, file.path, 3);
        AnyState state;
        const auto report = dump->read(state);
        CHECK(report.status == status);
        CHECK(report.line == line);
        CHECK(missing(report.message(), words).empty());
        CHECK(missing(report.message(), {file.path.c_str()}).empty());
        CHECK(state.x.size() == 0);
        CHECK(dump->read(state).status == status);
    };
    const auto with = [&](const std::string& old, const std::string& fresh) {
        std::string text = good;
        const auto at = text.find(old);
        REQUIRE(at != text.npos);
        return text.replace(at, old.size(), fresh);
    };
    const auto foreign = DumpStatus::foreign;
    refused("v 0 0 0\n", foreign, 1, {"\"v 0 0 0\"", "no item"});
    refused(std::string("PK\003\004\0\0\0\n", 8), foreign, 1, {"no text"});
    refused(std::string("\0\n", 2), foreign, 1, {"no text"});
    refused(std::string(1 << 17, 'x'), foreign, 1, {"no text"});
    refused("\xff\xfe\n", foreign, 1, {"\"??\""});
    refused(with("ITEM: UNITS\nsi", "ITEM: UNITS\nreal"), foreign, 2, {"neither si nor lj"});
    refused(with("ITEM: TIME\n0", "ITEM: TIME\n0s"), foreign, 4, {"time is no number"});
    refused(with("ITEM: TIME\n0\n", ""), foreign, 11, {"no ITEM: TIME"});
    refused(with("ATOMS\n3", "ATOMS\n4"), foreign, 8, {"\"4\" particles", "has 3"});
    refused(with("ATOMS\n3", "ATOMS\n99999999999999999999"), foreign, 8, {"has 3"});
    refused(with("ITEM: NUMBER OF ATOMS\n3\n", ""), foreign, 11, {"no NUMBER OF ATOMS"});
    refused(with("id x y z", "id xs ys zs"), foreign, 13, {"columns", "id xs ys"});
    refused(with("ATOMS id x", "ATOMS type x"), foreign, 13, {"columns"});
    refused(with(" y z", " x z"), foreign, 13, {"columns"});
    refused(with("vx vy", "vx vz"), foreign, 13, {"columns"});
    refused(with("\n2 ", "\n1 "), foreign, 15, {"id 1 comes twice"});
    refused(with("\n2 ", "\n0 "), foreign, 15, {"id 0 is no particle", "1 to 3"});
    refused(with("\n3 ", "\n4 "), foreign, 16, {"id 4 is no particle"});
    refused(with("\n2 ", "\n2.5 "), foreign, 15, {"whole number"});
    refused(with("\n2 ", "\n2 1 "), foreign, 15, {"too many columns"});
    refused(with("\n2 ", "\n2 x "), foreign, 15, {"no number"});
    refused(with("\n3 ", "\n3 nan "), DumpStatus::not_finite, 16, {"not finite"});
    refused(with("\n3 ", "\n3 -inf "), DumpStatus::not_finite, 16, {"not finite"});
    refused(with("\n3 ", "\n3\n"), foreign, 16, {"no number"});

    // What overflows a float is no frame of floats.
    put(file, with("\n3 ", "\n3 1e39 "));
    AnyState none;
    CHECK(open_dump({true, 2}, file.path, 3)->read(none).status == DumpStatus::not_finite);

    const auto nowhere = open_dump(flat, "no/such.dump", 3);
    CHECK(nowhere->read(none).status == DumpStatus::not_opened);
    CHECK(nowhere->read(none).message() == "no/such.dump: cannot be opened");
    CHECK(missing(message_of([&] { open_dump(flat, file.path, 0); }), {"particles is 0"}).empty());
}

}  // namespace taut_test::lammps_dump_test
