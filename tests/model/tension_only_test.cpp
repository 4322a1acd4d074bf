// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What makes TensionOnly a string; what it shares with all laws is tested in hookean_test.cpp.
#include <cmath>
#include <limits>
#include <taut/model/spring_system.hpp>
#include <taut/model/tension_only.hpp>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::tension_only_test {

TEMPLATE_TEST_CASE("tension_only: slack it is nothing, taut it is Hooke's spring", "[model]", float,
                   double) {
    Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const auto p = draw_parameters<TestType>(random, TensionOnly{});
        const auto L = static_cast<TestType>(random.uniform(0.1, 2));
        const auto l = static_cast<TestType>(random.uniform(0, 4));
        const bool taut = l > L;
        CHECK(TensionOnly::tension(p, L, l) == (taut ? taut::Hookean::tension(p, L, l) : 0));
        CHECK(TensionOnly::tension_slope(p, L, l) == (taut ? p.stiffness : 0));
        CHECK(TensionOnly::energy(p, L, l) == (taut ? taut::Hookean::energy(p, L, l) : 0));
    }
}

TEMPLATE_TEST_CASE(
    "tension_only: its slope is that of the slack side at l = L and k one ulp beyond", "[model]",
    float, double, long double) {
    Random random(2);
    for (int trial = 0; trial < 200; ++trial) {
        const TensionOnly::Parameters<TestType> p{static_cast<TestType>(random.uniform(20, 200))};
        const auto L = static_cast<TestType>(random.uniform(0.1, 2));
        const TestType below = std::nextafter(L, TestType(0));
        const TestType beyond = std::nextafter(L, TestType(4));
        CHECK(TensionOnly::tension_slope(p, L, below) == 0);
        CHECK(TensionOnly::tension_slope(p, L, L) == 0);
        CHECK(TensionOnly::tension_slope(p, L, beyond) == p.stiffness);
        CHECK(TensionOnly::tension(p, L, below) == 0);
        CHECK(TensionOnly::tension(p, L, L) == 0);
        CHECK(TensionOnly::tension(p, L, beyond) == p.stiffness * (beyond - L));
        CHECK(TensionOnly::energy(p, L, L) == 0);
        CHECK(TensionOnly::energy(p, L, beyond) > 0);
    }
}

TEMPLATE_TEST_CASE_SIG("tension_only: the energy of a scene is convex in its positions", "[model]",
                       ((int Dim), Dim), 1, 2, 3) {
    static_assert(TensionOnly::convex && !taut::Hookean::convex);
    const auto bends_down = [](const auto& system, Random& random) {
        auto a = random_state(random, system);
        auto b = random_state(random, system);
        a.v.setZero();
        b.v.setZero();
        auto between = a;
        const double t = random.uniform(0, 1);
        between.x = (1 - t) * a.x + t * b.x;
        const double chord = (1 - t) * system.energy(a) + t * system.energy(b);
        return system.energy(between) > chord + Tolerance<double>::rounding * 1e3;
    };
    int strings = 0;
    int springs = 0;
    for (std::uint32_t seed = 1; seed <= 500; ++seed) {
        Random random(seed);
        strings += bends_down(random_system<double, Dim, TensionOnly>(random), random);
        springs += bends_down(random_system<double, Dim>(random), random);
    }
    CHECK(strings == 0);
    CHECK(springs > 0);  // what the same poses show of springs that push
}

}  // namespace taut_test::tension_only_test
