// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/explicit_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"

namespace taut_test::explicit_euler_test {

TEST_CASE("explicit_euler: a step satisfies its own update equation", "[integrator]") {
    Random random(1);
    RandomOptions options;
    options.rayleigh = true;
    options.dampers = true;
    const auto system = random_system<double, 3>(random, options);
    auto state = random_state(random, system);
    const auto before = state;
    const double h = 0.03125;
    taut::ExplicitEuler stepper(system);
    const taut::Report report = stepper.step(state, h);
    REQUIRE(report);
    CHECK(report.residual == 0);

    const auto dense = dense_matrices(system, before);
    Eigen::VectorXd v = flat(before.v);
    const Eigen::VectorXd f = flat_force(system, before);
    for (const Index dof : free_dofs(system)) v[dof] += h * f[dof] / dense.M(dof, dof);
    CHECK(distance(flat(state.v), v) <= Tolerance<double>::rounding * largest(v));
    CHECK(distance(flat(state.x), flat(before.x) + h * flat(before.v)) <=
          Tolerance<double>::rounding);
    CHECK(state.time == h);
}

TEST_CASE("explicit_euler: on a linear system a step is I + hC", "[integrator]") {
    const auto springs = linear_scene<double, 2>(true);
    const auto linear = springs.linearize(springs.initial_state());
    Random random(2);
    auto u = random_state(random, linear);
    const auto before = u;
    taut::ExplicitEuler stepper(linear);
    REQUIRE(stepper.step(u, 0.0625));
    const Eigen::MatrixXd K(linear.stiffness());
    const Eigen::MatrixXd D(linear.damping());
    const Eigen::VectorXd f = linear.load() - K * flat(before.x) - D * flat(before.v);
    const Eigen::VectorXd v = flat(before.v) + 0.0625 * f.cwiseQuotient(linear.mass());
    CHECK(distance(flat(u.v), v) <= Tolerance<double>::rounding * largest(v));
    CHECK(distance(flat(u.x), flat(before.x) + 0.0625 * flat(before.v)) <=
          Tolerance<double>::rounding);
}

TEST_CASE("explicit_euler: one undamped mode grows by sqrt(1 + z^2) a step", "[integrator]") {
    const auto system = taut::chain<double, 1>({1, taut::ChainEnds::fixed_free, 1, 4});
    auto state = system.initial_state();
    state.x(0, 0) += 0.0625;
    taut::ExplicitEuler stepper(system);
    REQUIRE(stepper.step(state, 0.125, 64));
    const double size = std::hypot(state.x(0, 0), state.v(0, 0) / 2);
    CHECK_THAT(size, Catch::Matchers::WithinRel(0.0625 * std::pow(1 + 0.0625, 32),
                                                Tolerance<double>::accumulated));
}

TEST_CASE("explicit_euler: divergence is reported and the state put back", "[integrator]") {
    check_divergence_is_reported<taut::ExplicitEuler>();
}

TEMPLATE_TEST_CASE("explicit_euler: count steps are count single steps, to the bit", "[integrator]",
                   float, double) {
    check_counted_steps_are_single_steps<taut::ExplicitEuler, TestType, 3>();
}

TEMPLATE_TEST_CASE("explicit_euler: a bad step or state is reported and nothing is touched",
                   "[integrator][bad_input]", float, double) {
    check_bad_input<taut::ExplicitEuler, TestType>();
}

TEMPLATE_TEST_CASE("explicit_euler: pinned particles obey their velocity", "[integrator]", float,
                   double) {
    check_pinned_particles_obey_their_velocity<taut::ExplicitEuler, TestType>();
}

TEMPLATE_TEST_CASE("explicit_euler: linear momentum of an unpinned scene is kept to rounding",
                   "[integrator]", (Case<float, 2>), (Case<double, 3>)) {
    check_linear_momentum_is_kept<taut::ExplicitEuler, typename TestType::Scalar, TestType::Dim>();
}

TEMPLATE_TEST_CASE(
    "explicit_euler: a linear scene moves alike through SpringSystem and LinearSystem",
    "[integrator]", (Case<float, 1>), (Case<double, 3>)) {
    check_linear_scene<taut::ExplicitEuler, typename TestType::Scalar, TestType::Dim>();
}

TEST_CASE("explicit_euler: the measured order of convergence is the declared one", "[integrator]") {
    using Stepper = taut::ExplicitEuler<taut::SpringSystem<double, 3>>;
    CHECK(Stepper::method == taut::Method::explicit_euler);
    CHECK_THAT((measured_order<taut::ExplicitEuler, 3>()),
               Catch::Matchers::WithinAbs(Stepper::order, 0.05));
}

TEST_CASE("explicit_euler: changes of the system and the state between steps are taken up",
          "[integrator]") {
    check_takes_up_all_changes<taut::ExplicitEuler>();
}

TEST_CASE("explicit_euler: a scene without free particles is stepped without failure",
          "[integrator]") {
    check_nothing_free<taut::ExplicitEuler>();
}

}  // namespace taut_test::explicit_euler_test
