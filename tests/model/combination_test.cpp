// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <limits>
#include <taut/model/combination.hpp>
#include <type_traits>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::combination_test {

using taut::Combination;
using namespace taut::matrices;

namespace {

std::array<double, 4> factors(const Combination& c) {
    return {c.mass(), c.damping(), c.stiffness(), c.projected()};
}

}  // namespace

TEST_CASE("combination: a sum has the factors that it is written with", "[model]") {
    Random random(4100);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const double a = random.uniform(-9, 9);
        const double b = random.uniform(-9, 9);
        const double c = random.uniform(-9, 9);
        const double d = random.uniform(-9, 9);
        CHECK((factors(a * M + b * D + c * K + d * K_plus) == std::array{a, b, c, d}));
        CHECK((factors(a * M - b * D - c * K - d * K_plus) == std::array{a, -b, -c, -d}));
        CHECK((factors(-(a * M - b * K)) == std::array{-a, 0.0, b, 0.0}));
        CHECK((factors(b * (a * D + c * K_plus)) == std::array{0.0, b * a, 0.0, b * c}));
    }
}

TEST_CASE("combination: what a sum leaves out stays out, at an infinite factor too", "[model]") {
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK((factors(4 * M - infinite * K_plus) == std::array{4.0, 0.0, 0.0, -infinite}));
    CHECK((factors(infinite * D + K) == std::array{0.0, infinite, 1.0, 0.0}));
}

TEST_CASE("combination: four numbers in braces are none", "[model]") {
    CHECK_FALSE(std::is_constructible_v<Combination, double, double, double, double>);
    CHECK_FALSE(std::is_constructible_v<Combination, double, double, double>);
    CHECK_FALSE(std::is_convertible_v<double, Combination>);
}

}  // namespace taut_test::combination_test
