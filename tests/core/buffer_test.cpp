// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/core/buffer.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::buffer_test {

namespace {

struct Pair {
    int first, second;
    friend bool operator==(const Pair& a, const Pair& b) {
        return a.first == b.first && a.second == b.second;
    }
};

template <class T>
void check_same(const taut::Buffer<T>& buffer, const std::vector<T>& vector) {
    REQUIRE(buffer.size() == vector.size());
    CHECK(buffer.empty() == vector.empty());
    CHECK(std::equal(buffer.begin(), buffer.end(), vector.begin()));
    if (!vector.empty()) CHECK(buffer.back() == vector.back());
}

template <class T, class Draw>
void check_as_vector(std::uint32_t seed, const Draw& draw) {
    Random random(seed);
    taut::Buffer<T> buffer, other;
    std::vector<T> vector, twin;
    for (int i = 0; i < 4000; ++i) {
        INFO("call " << i << " of seed " << seed);
        const auto size = static_cast<std::size_t>(random.below(40));
        switch (random.below(10)) {
            case 0:
                buffer.assign(size, draw(random, i)), vector.assign(size, draw(random, i));
                break;
            case 1:
                buffer.resize(size, draw(random, i)), vector.resize(size, draw(random, i));
                break;
            case 2: buffer.clear(), vector.clear(); break;
            case 3: other = buffer, twin = vector; break;
            case 4: std::swap(buffer, other), std::swap(vector, twin); break;
            case 5: buffer.fit(), vector.shrink_to_fit(); break;
            case 6: buffer = taut::Buffer<T>(other), vector = std::vector<T>(twin); break;
            case 7:  // an element of its own
                if (vector.empty()) break;
                buffer.push_back(buffer[vector.size() / 2]);
                vector.push_back(T(vector[vector.size() / 2]));
                break;
            case 8:
                if (vector.empty()) break;
                buffer.resize(vector.size() + size, buffer[0]);
                vector.resize(vector.size() + size, T(vector[0]));
                break;
            default: buffer.push_back(draw(random, i)), vector.push_back(draw(random, i));
        }
        check_same(buffer, vector);
        check_same(other, twin);
    }
}

}  // namespace

TEST_CASE("buffer: does what a std::vector does", "[core]") {
    check_as_vector<int>(900, [](Random&, int i) { return i; });
    check_as_vector<double>(901, [](Random&, int i) { return 0.5 * i; });
    check_as_vector<Pair>(902, [](Random&, int i) { return Pair{i, -i}; });
}

TEST_CASE("buffer: is aligned as registers like it", "[core]") {
    for (std::size_t size = 1; size < 100; ++size) {
        const taut::Buffer<float> buffer(size, 0.0f);
        CHECK(reinterpret_cast<std::uintptr_t>(buffer.data()) % EIGEN_DEFAULT_ALIGN_BYTES == 0);
    }
}

}  // namespace taut_test::buffer_test
