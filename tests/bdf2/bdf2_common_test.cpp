// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What all steppers promise, for BDF2: tests in bdf2_test.cpp are its own.
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"
#include "direct_bdf2.hpp"

namespace taut_test::bdf2_common_test {

TEMPLATE_TEST_CASE("bdf2: count steps are count single steps, to the bit", "[integrator]", float,
                   double) {
    check_counted_steps_are_single_steps<taut::Bdf2, TestType, 3>();
}

TEMPLATE_TEST_CASE("bdf2: a bad step or state is reported and nothing is touched",
                   "[integrator][bad_input]", float, double) {
    check_bad_input<taut::Bdf2, TestType>();
}

TEMPLATE_TEST_CASE("bdf2: pinned particles obey their velocity", "[integrator]", float, double) {
    check_pinned_particles_obey_their_velocity<taut::Bdf2, TestType>();
}

TEMPLATE_TEST_CASE("bdf2: linear momentum of an unpinned scene is kept to rounding", "[integrator]",
                   (Case<float, 2>), (Case<double, 3>)) {
    check_linear_momentum_is_kept<DirectBdf2, typename TestType::Scalar, TestType::Dim>();
}

TEMPLATE_TEST_CASE("bdf2: a linear scene moves alike through SpringSystem and LinearSystem",
                   "[integrator]", (Case<float, 1>), (Case<double, 3>)) {
    check_linear_scene<DirectBdf2, typename TestType::Scalar, TestType::Dim>();
}

TEST_CASE("bdf2: changes of the system and the state between steps are taken up", "[integrator]") {
    check_takes_up_all_changes<taut::Bdf2>();
}

TEST_CASE("bdf2: a scene without free particles is stepped without failure", "[integrator]") {
    check_nothing_free<taut::Bdf2>();
}

}  // namespace taut_test::bdf2_common_test
