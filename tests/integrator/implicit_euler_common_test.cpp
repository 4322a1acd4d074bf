// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What all steppers promise, for implicit Euler: tests in implicit_euler_test.cpp are its own.
#include <taut/integrator/implicit_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"
#include "../support/direct_euler.hpp"

namespace taut_test::implicit_euler_common_test {

TEMPLATE_TEST_CASE("implicit_euler: count steps are count single steps, to the bit", "[integrator]",
                   float, double) {
    check_counted_steps_are_single_steps<taut::ImplicitEuler, TestType, 3>();
}

TEMPLATE_TEST_CASE("implicit_euler: a bad step or state is reported and nothing is touched",
                   "[integrator][bad_input]", float, double) {
    check_bad_input<taut::ImplicitEuler, TestType>();
}

TEMPLATE_TEST_CASE("implicit_euler: pinned particles obey their velocity", "[integrator]", float,
                   double) {
    check_pinned_particles_obey_their_velocity<taut::ImplicitEuler, TestType>();
}

TEMPLATE_TEST_CASE("implicit_euler: linear momentum of an unpinned scene is kept to rounding",
                   "[integrator]", (Case<float, 2>), (Case<double, 3>)) {
    check_linear_momentum_is_kept<DirectEuler, typename TestType::Scalar, TestType::Dim>();
}

TEMPLATE_TEST_CASE(
    "implicit_euler: a linear scene moves alike through SpringSystem and LinearSystem",
    "[integrator]", (Case<float, 1>), (Case<double, 3>)) {
    check_linear_scene<DirectEuler, typename TestType::Scalar, TestType::Dim>();
}

TEST_CASE("implicit_euler: the measured order of convergence is the declared one", "[integrator]") {
    using Stepper = taut::ImplicitEuler<taut::SpringSystem<double, 3>>;
    CHECK(Stepper::method == taut::Method::implicit_euler);
    CHECK_THAT((measured_order<DirectEuler, 3>()),
               Catch::Matchers::WithinAbs(Stepper::order, 0.05));
}

TEST_CASE("implicit_euler: changes of the system and the state between steps are taken up",
          "[integrator]") {
    check_takes_up_all_changes<taut::ImplicitEuler>();
}

TEST_CASE("implicit_euler: a scene without free particles is stepped without failure",
          "[integrator]") {
    check_nothing_free<taut::ImplicitEuler>();
}

}  // namespace taut_test::implicit_euler_common_test
