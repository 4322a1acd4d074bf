// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What all explicit steppers promise: tests in the files of their names are their own.
#include <taut/integrator/explicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"

namespace taut_test::explicit_common_test {

using taut::ExplicitEuler;
using taut::SymplecticEuler;
using taut::VelocityVerlet;

TEST_CASE("explicit_common: divergence is reported and the state put back", "[integrator]") {
    check_divergence_is_reported<ExplicitEuler>();
    check_divergence_is_reported<SymplecticEuler>();
    check_divergence_is_reported<VelocityVerlet>();
}

TEMPLATE_TEST_CASE("explicit_common: count steps are count single steps, to the bit",
                   "[integrator]", float, double) {
    check_counted_steps_are_single_steps<ExplicitEuler, TestType, 3>();
    check_counted_steps_are_single_steps<SymplecticEuler, TestType, 3>();
    check_counted_steps_are_single_steps<VelocityVerlet, TestType, 3>();
}

TEMPLATE_TEST_CASE("explicit_common: a bad step or state is reported and nothing is touched",
                   "[integrator][bad_input]", float, double) {
    check_bad_input<ExplicitEuler, TestType>();
    check_bad_input<SymplecticEuler, TestType>();
    check_bad_input<VelocityVerlet, TestType>();
}

TEMPLATE_TEST_CASE("explicit_common: pinned particles obey their velocity", "[integrator]", float,
                   double) {
    check_pinned_particles_obey_their_velocity<ExplicitEuler, TestType>();
    check_pinned_particles_obey_their_velocity<SymplecticEuler, TestType>();
    check_pinned_particles_obey_their_velocity<VelocityVerlet, TestType>();
}

TEMPLATE_TEST_CASE("explicit_common: linear momentum of an unpinned scene is kept to rounding",
                   "[integrator]", (Case<float, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    check_linear_momentum_is_kept<ExplicitEuler, Scalar, TestType::Dim>();
    check_linear_momentum_is_kept<SymplecticEuler, Scalar, TestType::Dim>();
    check_linear_momentum_is_kept<VelocityVerlet, Scalar, TestType::Dim>();
}

TEMPLATE_TEST_CASE(
    "explicit_common: a linear scene moves alike through SpringSystem and LinearSystem",
    "[integrator]", (Case<float, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    check_linear_scene<ExplicitEuler, Scalar, TestType::Dim>();
    check_linear_scene<SymplecticEuler, Scalar, TestType::Dim>();
    check_linear_scene<VelocityVerlet, Scalar, TestType::Dim>();
}

TEST_CASE("explicit_common: the measured order of convergence is the declared one",
          "[integrator]") {
    using System = taut::SpringSystem<double, 3>;
    using Catch::Matchers::WithinAbs;
    CHECK(ExplicitEuler<System>::method == taut::Method::explicit_euler);
    CHECK_THAT((measured_order<ExplicitEuler, 3>()), WithinAbs(ExplicitEuler<System>::order, 0.05));
    CHECK(SymplecticEuler<System>::method == taut::Method::symplectic_euler);
    CHECK_THAT((measured_order<SymplecticEuler, 3>()),
               WithinAbs(SymplecticEuler<System>::order, 0.05));
    CHECK(VelocityVerlet<System>::method == taut::Method::velocity_verlet);
    CHECK_THAT((measured_order<VelocityVerlet, 3>()),
               WithinAbs(VelocityVerlet<System>::order, 0.05));
}

TEST_CASE("explicit_common: changes of the system and the state between steps are taken up",
          "[integrator]") {
    check_takes_up_all_changes<ExplicitEuler>();
    check_takes_up_all_changes<SymplecticEuler>();
    check_takes_up_all_changes<VelocityVerlet>();
}

TEST_CASE("explicit_common: a scene without free particles is stepped without failure",
          "[integrator]") {
    check_nothing_free<ExplicitEuler>();
    check_nothing_free<SymplecticEuler>();
    check_nothing_free<VelocityVerlet>();
}

}  // namespace taut_test::explicit_common_test
