// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>
#include <taut/network/spring_system.hpp>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "plain_steps.hpp"
#include "random_system.hpp"
#include "tolerance.hpp"

namespace taut_test {

/// Some steps of a stepper, more than a wave, are those of the plain path, to rounding.
template <template <class...> class Stepper, class System>
void check_equals_plain_path(const System& system, const typename System::State& start) {
    using Scalar = typename System::Scalar;
    Stepper fast_stepper(system);
    auto state = start;
    auto expected = start;
    const auto h = static_cast<Scalar>(0.001);
    REQUIRE(fast_stepper.step(state, h));
    REQUIRE(fast_stepper.step(state, h, 11));
    plain_steps<Stepper<System>::method>(system, expected, h, 12);
    const double force_scale = largest(expected.v) + largest(expected.x);
    CHECK(distance(state.x, expected.x) <= Tolerance<Scalar>::rounding * force_scale);
    CHECK(distance(state.v, expected.v) <= Tolerance<Scalar>::rounding * force_scale);
    CHECK(distance(state.v, start.v) > 1e-4);
    CHECK(state.time == expected.time);
}

/// A net of rows × columns with springs to neighbours and diagonals, of random stiffness.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> net(Random& random, Index rows, Index columns) {
    taut::SpringSystem<Scalar, Dim> system;
    for (Index i = 0; i < rows * columns; ++i) {
        system.add_particle(random.vector<Scalar, Dim>(-1, 1),
                            static_cast<Scalar>(random.uniform(0.5, 2)));
    }
    const auto join = [&](Index rise, Index run) {
        for (Index r = 0; r + rise < rows; ++r) {
            for (Index c = run < 0 ? -run : 0; c + run < columns && c < columns; ++c) {
                const Index a = r * columns + c;
                system.add_spring(taut::Spring<Scalar, taut::Hookean>{
                    a,
                    a + rise * columns + run,
                    {static_cast<Scalar>(random.uniform(20, 200))},
                    static_cast<Scalar>(random.uniform(0.2, 1.4))});
            }
        }
    };
    join(0, 1);
    join(1, 0);
    join(1, 1);
    join(1, -1);
    return system;
}

/// Particles at random in a long box, each with springs to some that come shortly after it there:
/// an irregular mesh, over several blocks.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> irregular(Random& random, int particles, bool damped) {
    taut::SpringSystem<Scalar, Dim> system;
    std::vector<Index> shuffled(static_cast<std::size_t>(particles));
    std::iota(shuffled.begin(), shuffled.end(), Index(0));
    for (int i = particles - 1; i > 0; --i) {
        std::swap(shuffled[static_cast<std::size_t>(i)],
                  shuffled[static_cast<std::size_t>(random.below(i + 1))]);
    }
    for (int i = 0; i < particles; ++i) {
        system.add_particle(random.vector<Scalar, Dim>(-1, 1),
                            static_cast<Scalar>(random.uniform(0.5, 2)));
    }
    for (int i = 0; i < particles; ++i) {
        for (Index k = 1 + random.below(5); k > 0; --k) {
            const Index j = i + 1 + random.below(40);
            if (j >= particles) continue;
            system.add_spring(taut::Spring<Scalar, taut::Hookean>{
                shuffled[static_cast<std::size_t>(i)],
                shuffled[static_cast<std::size_t>(j)],
                {static_cast<Scalar>(random.uniform(20, 200))},
                static_cast<Scalar>(random.uniform(0.2, 1.4)),
                static_cast<Scalar>(damped ? random.uniform(0, 0.5) : 0)});
        }
    }
    if (damped) system.set_rayleigh({0.25, 0.0078125});
    if (damped) system.pin(particles / 3);
    system.set_gravity(random.vector<Scalar, Dim>(-3, 3));
    return system;
}

}  // namespace taut_test
