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
    const auto linear = taut::linearize(springs, springs.initial_state());
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

}  // namespace taut_test::explicit_euler_test
