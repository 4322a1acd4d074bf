// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"

namespace taut_test::velocity_verlet_test {

TEST_CASE("velocity_verlet: a step satisfies its own update equation", "[integrator]") {
    Random random(1);
    RandomOptions options;
    options.rayleigh = true;
    options.dampers = true;
    const auto system = random_system<double, 3>(random, options);
    auto state = random_state(random, system);
    const double h = 0.03125;
    taut::VelocityVerlet stepper(system);
    for (int step = 0; step < 3; ++step) {  // the later ones use a force kept from before
        const auto before = state;
        const taut::Report report = stepper.step(state, h);
        REQUIRE(report);
        CHECK(report.residual == 0);

        // v½ = v + ½h M⁻¹f(x, v') with v' = the velocity that f was last evaluated with.
        auto half = before;
        half.x = state.x;
        half.v = (state.x - before.x) / h;
        const auto dense = dense_matrices(system, before);
        Eigen::VectorXd v = flat(half.v);
        const Eigen::VectorXd f = flat_force(system, half);
        for (const Index dof : free_dofs(system)) v[dof] += h / 2 * f[dof] / dense.M(dof, dof);
        CHECK(distance(flat(state.v), v) <= 100 * Tolerance<double>::rounding * largest(v));
        if (step == 0) {
            Eigen::VectorXd kicked = flat(before.v);
            const Eigen::VectorXd first = flat_force(system, before);
            for (const Index dof : free_dofs(system))
                kicked[dof] += h / 2 * first[dof] / dense.M(dof, dof);
            CHECK(distance(flat(half.v), kicked) <=
                  100 * Tolerance<double>::rounding * largest(kicked));
        }
    }
}

TEST_CASE("velocity_verlet: in positions and half-step velocities it is symplectic Euler",
          "[integrator]") {
    const auto system = smooth_scene<double, 3>();
    auto verlet_state = system.initial_state();
    auto euler_state = verlet_state;
    const double h = 0.01;
    taut::Points<double, 3> f;
    system.force(euler_state, f);
    for (Index i = 0; i < system.size(); ++i)
        euler_state.v.col(i) -= h / 2 * system.inverse_mass()[i] * f.col(i);
    taut::VelocityVerlet verlet(system);
    taut::SymplecticEuler euler(system);
    REQUIRE(verlet.step(verlet_state, h, 100));
    REQUIRE(euler.step(euler_state, h, 100));
    CHECK(distance(verlet_state.x, euler_state.x) <= Tolerance<double>::accumulated);
}

TEST_CASE("velocity_verlet: an undamped step is undone by a step with the velocity turned round",
          "[integrator]") {
    const auto system = smooth_scene<double, 2>();
    Random random(2);
    auto state = system.initial_state();
    state.v = random.points<double, 2>(6, -1, 1);
    const auto start = state;
    taut::VelocityVerlet stepper(system);
    REQUIRE(stepper.step(state, 0.01, 100));
    state.v *= -1;
    REQUIRE(stepper.step(state, 0.01, 100));
    CHECK(distance(state.x, start.x) <= Tolerance<double>::accumulated);
    CHECK(distance(state.v, -start.v) <= Tolerance<double>::accumulated);
}

TEST_CASE("velocity_verlet: the force is evaluated once a step, and again for an edited state",
          "[integrator]") {
    Random random(3);
    auto system = random_system<double, 2>(random);
    int calls = 0;
    system.set_external_force([&](const auto&, auto&) { ++calls; });
    auto state = random_state(random, system);
    taut::VelocityVerlet stepper(system);
    const auto evaluations = [&](Index count) {
        calls = 0;
        REQUIRE(stepper.step(state, 0.001, count));
        return calls;
    };
    CHECK(evaluations(10) == 11);
    CHECK(evaluations(10) == 10);
    CHECK(evaluations(1) == 1);
    state.x(0, 4) += 0.125;
    CHECK(evaluations(10) == 11);
    state.v(1, 5) -= 0.125;
    CHECK(evaluations(10) == 11);
    state.time += 1;
    CHECK(evaluations(10) == 11);
    system.set_mass(3, 1);
    CHECK(evaluations(10) == 11);
    CHECK(evaluations(10) == 10);

    calls = 0;  // a failed call forgets the force
    CHECK_FALSE(stepper.step(state, -1.0));
    CHECK(calls == 0);
    CHECK(evaluations(1) == 2);
}

TEST_CASE(
    "velocity_verlet: a force that depends on time is taken at the step's end: order 2 there, too",
    "[integrator]") {
    taut::SpringSystem<double, 1> system;
    system.add_particle(Eigen::Matrix<double, 1, 1>(0.0), 1);
    system.set_external_force([](const auto& state, auto& f) { f(0, 0) += std::cos(state.time); });
    const auto error = [&](int steps) {
        auto state = system.initial_state();
        taut::VelocityVerlet stepper(system);
        REQUIRE(stepper.step(state, 1.0 / steps, steps));
        return std::abs(state.v(0, 0) - std::sin(1.0));
    };
    CHECK_THAT(std::log2(error(200) / error(400)), Catch::Matchers::WithinAbs(2, 0.05));
}

}  // namespace taut_test::velocity_verlet_test
