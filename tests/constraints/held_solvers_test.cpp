// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/implicit_euler.hpp>
#include <taut/newton/newton.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "held.hpp"

namespace taut_test::held_solvers_test {

namespace {

struct Newton : taut::NewtonEuler<Springs> {
    explicit Newton(const Springs& system)
        : taut::NewtonEuler<Springs>(system, [] {
              Options options;
              options.tolerance = 1e-12;
              return options;
          }()) {}
};

}  // namespace

TEST_CASE("held_solvers: constraints of a linear system, and their release", "[constraints]") {
    Random random(5);
    const auto springs = draw_system(random);
    auto pose = springs.initial_state();
    pose.x *= 3;
    const auto linear = taut::linearize(springs, pose);
    auto u = linear.initial_state();
    taut::ConstrainedEuler stepper(linear);
    stepper.constraints().fix(4);
    REQUIRE(stepper.step(u, 0.1, 5));
    CHECK(u.x(0, 4) == 0);
    CHECK(u.x(0, 5) != 0);
    stepper.constraints().release(4);
    auto expected = u;
    REQUIRE(stepper.step(u, 0.1));
    REQUIRE(taut::ImplicitEuler(linear).step(expected, 0.1));
    CHECK(distance(u.v, expected.v) <= Tolerance<double>::accumulated);
}

TEST_CASE("held_solvers: filtered conjugate gradients take the direct solver's step",
          "[constraints]") {
    Random random(8);
    const auto system = draw_system(random);
    auto by_factors = random_state(random, system);
    auto by_gradients = by_factors;
    taut::ConstrainedEuler<Springs, taut::SparseCholesky<double>> direct(system);
    Constrained filtered(system);
    const auto hold = [](auto& constraints, int phase) {
        constraints.clear();
        constraints.hold_in_plane(3, {1, -1, 2}, 0.5 * phase);
        if (phase != 1) constraints.prescribe(6, {0, 1.0 * phase, 0});
        if (phase != 2) constraints.hold_on_line(4, {1, 1, 0});
    };
    for (const int phase : {0, 1, 2}) {
        hold(direct.constraints(), phase);
        hold(filtered.constraints(), phase);
        REQUIRE(direct.step(by_factors, 0.02, 3));
        REQUIRE(filtered.step(by_gradients, 0.02, 3));
        CHECK(distance(by_factors.v, by_gradients.v) <= 1e-9 * largest(by_factors.v));
        CHECK(distance(direct.constraint_forces(), filtered.constraint_forces()) <=
              1e-7 * largest(direct.constraint_forces()));
    }
}

TEST_CASE("held_solvers: with its forces Newton's step is that of free particles",
          "[constraints]") {
    check_forces<Newton>(1e-8);
}

}  // namespace taut_test::held_solvers_test
