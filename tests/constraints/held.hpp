// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <taut/constraints/constraints.hpp>

#include "../support/catch.hpp"
#include "../support/held_once.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test {

using Springs = taut::SpringSystem<double, 3>;

inline Springs draw_system(Random& random) {
    RandomOptions options;
    options.dampers = options.rayleigh = true;
    return random_like<Springs>(random, options);
}

/// Solved to rounding.
template <class Stepper>
struct Tight : Stepper {
    template <class System>
    explicit Tight(const System& system) : Stepper(system) {
        constexpr auto epsilon = std::numeric_limits<typename System::Scalar>::epsilon();
        this->configure([](auto& solver) { solver.setTolerance(16 * epsilon); });
    }
};
using Constrained = Tight<taut::ConstrainedEuler<Springs>>;

/// With its constraint forces as external ones, and no constraint, a step is the same.
template <class Stepper>
void check_forces(double tolerance) {
    Random random(4);
    auto system = draw_system(random);
    const auto start = random_state(random, system);
    Stepper stepper(system);
    stepper.constraints().hold_in_plane(3, {1, 2, -1}, 0.5);
    stepper.constraints().hold_on_line(4, {0, 1, 1});
    stepper.constraints().prescribe(7, {0, 0, 1});
    auto held = start;
    REQUIRE(stepper.step(held, 0.05));
    CHECK_THAT(Eigen::Vector3d(1, 2, -1).normalized().dot(held.v.col(3)),
               WithinAbs(0.5, Tolerance<double>::accumulated));
    CHECK(distance(held.v.col(7), Eigen::Vector3d(0, 0, 1)) <= Tolerance<double>::accumulated);
    const auto forces = stepper.constraint_forces();
    CHECK(largest(forces.col(3)) > 0);
    CHECK(Eigen::Vector3d(forces.col(3)).cross(Eigen::Vector3d(1, 2, -1)).norm() <=
          tolerance * largest(forces));
    CHECK((forces.col(5).array() == 0).all());
    auto released = held;
    stepper.constraints().clear();
    REQUIRE(stepper.step(released, 0.05));
    CHECK(stepper.constraint_forces().cols() == 0);
    system.set_external_force([forces](const auto&, auto& f) { f += forces; });
    auto pushed = start;
    Stepper free(system);
    REQUIRE(free.step(pushed, 0.05));
    CHECK(distance(held.v, pushed.v) <= tolerance * largest(held.v));
}

}  // namespace taut_test
