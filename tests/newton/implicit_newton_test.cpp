// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// Implicit Euler solved by Newton's method.
#include <cmath>
#include <taut/newton/newton.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/solver/conjugate_gradient.hpp>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::implicit_newton_test {

using taut::NewtonEuler;
using taut::Status;

namespace {

template <class System, class Solver = taut::SparseCholesky<typename System::Scalar>>
NewtonEuler<System, Solver> newton(const System& system, int iterations = 60,
                                   double tolerance = 1e-11) {
    typename NewtonEuler<System, Solver>::Options options;
    options.iterations = iterations;
    options.tolerance = tolerance;
    return NewtonEuler<System, Solver>(system, options);
}

}  // namespace

TEMPLATE_TEST_CASE("implicit_newton: a step satisfies the nonlinear equation", "[integrator]",
                   (taut::SpringSystem<double, 1>),
                   (taut::SpringSystem<double, 3, taut::Hookean, Glue>)) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        for (const double h : {0.01, 0.3}) {
            INFO("seed " << seed << ", h " << h);
            Random random(seed);
            RandomOptions options;
            options.rayleigh = true;
            options.dampers = true;
            auto system = random_like<TestType>(random, options);
            system.pin(5);
            auto state = random_state(random, system);
            const auto before = state;
            auto stepper = newton(system);
            REQUIRE(stepper.step(state, h));

            // M(v⁺ − v) = h(f(x⁺) − D(x)v⁺) on the free particles.
            const auto dense = dense_matrices(system, before);
            auto undamped = system;
            undamped.set_rayleigh({});
            auto still = state;
            still.v.setZero();
            const auto free = free_dofs(system);
            const Eigen::VectorXd impulse =
                dense.M * (flat(state.v) - flat(before.v)) -
                h * (flat_force(undamped, still) - dense.D * flat(state.v));
            const double size = largest(Eigen::VectorXd(dense.M * flat(state.v)));
            CHECK(largest(Eigen::VectorXd(impulse(free))) <= 1e-8 * size);
            CHECK(distance(state.x, before.x + h * state.v) <= Tolerance<double>::rounding * 10);
        }
    }
}

TEST_CASE("implicit_newton: with a convex energy no step raises the energy, at any h",
          "[integrator]") {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        auto system = random_system<double, 3, TensionOnly>(random);  // [T24]
        for (const double h : {0.01, 0.1, 1.0}) {
            INFO("seed " << seed << ", h " << h);
            auto state = random_state(random, system);
            state.v.leftCols(2).setZero();  // fixed pins
            auto stepper = newton(system);
            double energy = system.energy(state);
            const double size = std::abs(energy) + 100;
            for (int i = 0; i < 20; ++i) {
                REQUIRE(stepper.step(state, h));
                const double next = system.energy(state);
                CHECK(next <= energy + 1e-9 * (size + std::abs(energy)));
                energy = next;
            }
        }
    }
}

TEST_CASE("implicit_newton: a spring of 1e20 N/m excuses no particle but its own", "[integrator]") {
    const int count = 200;
    int converged = 0;
    for (std::uint32_t seed = 1; seed <= count; ++seed) {
        Random random(seed);
        const double h = std::pow(10, random.uniform(-3, 0));
        auto system = random_system<double, 3, TensionOnly>(random);
        auto alone = random_state(random, system);
        alone.v.leftCols(2).setZero();
        auto stepper = newton(system);
        auto beside = alone;
        REQUIRE(stepper.step(alone, h));

        // The same with a pair beside it that nothing joins to it.
        const Index a = system.add_particle(random.vector<double, 3>(2, 3), 1);
        const Index b = system.add_particle(random.vector<double, 3>(4, 5), 1);
        system.add_spring<TensionOnly>(a, b, {1e20});
        const auto placed = system.initial_state();
        beside.x.conservativeResize(Eigen::NoChange, system.size());
        beside.v.conservativeResize(Eigen::NoChange, system.size());
        beside.x.rightCols(2) = placed.x.rightCols(2);
        beside.v.rightCols(2) = random.points<double, 3>(2, -1, 1);
        auto with_pair = newton(system, 60, 1e-6);
        if (!with_pair.step(beside, h)) continue;
        ++converged;
        INFO("seed " << seed << ", h " << h);
        CHECK(distance(beside.v.leftCols(8), alone.v) <= 1e-3 * largest(alone.v));
    }
    CHECK(converged >= count / 2);
}

TEMPLATE_TEST_CASE("implicit_newton: the work of moving pins and constraints is no gain",
                   "[integrator]", float, double) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        RandomOptions options;
        options.dampers = true;
        options.rayleigh = seed % 2 == 0;
        const auto system = random_system<TestType, 3, TensionOnly>(random, options);
        auto state = random_state(random, system);
        state.v.leftCols(2) *= 20;  // the pins
        auto stepper = newton(system, 100, 1e-6);
        stepper.constraints().hold_in_plane(3, random.vector<TestType, 3>(1, 2), 10);
        stepper.constraints().prescribe(5, random.vector<TestType, 3>(-20, 20));
        const auto before = system.energy(state);
        INFO("seed " << seed);
        REQUIRE(stepper.step(state, TestType(0.1)));
        CHECK(system.energy(state) > before);
    }
}

TEST_CASE("implicit_newton: too few iterations are reported and the state is untouched",
          "[integrator]") {
    Random random(4);
    const auto system = random_system<double, 3>(random);
    auto state = random_state(random, system);
    const auto before = state;
    auto stepper = newton(system, 2, 1e-10);
    const taut::Report report = stepper.step(state, 0.1);
    CHECK(report.status == Status::not_converged);
    CHECK(report.residual > 1e-10);
    CHECK(report.solves == 2);
    CHECK(same_bits(state, before));
    auto patient = newton(system);
    CHECK(patient.step(state, 0.1));
}

TEST_CASE("implicit_newton: float reaches what its rounding admits", "[integrator]") {
    Random random(5);
    const auto system = random_system<float, 2>(random);
    auto state = random_state(random, system);
    auto stepper = newton(system, 60, 1e-12);  // out of reach
    const taut::Report report = stepper.step(state, 0.05F, 5);
    CHECK(report);
    CHECK(report.residual < 1e-3);
}

TEST_CASE("implicit_newton: an inexact solver converges to the same step", "[integrator]") {
    Random random(6);
    const auto system = random_system<double, 3>(random);
    using System = std::decay_t<decltype(system)>;
    auto by_factors = random_state(random, system);
    auto by_gradients = by_factors;
    auto factors = newton(system);
    auto gradients = newton<System, taut::ConjugateGradient<double, 3>>(system);
    REQUIRE(factors.step(by_factors, 0.02, 3));
    REQUIRE(gradients.step(by_gradients, 0.02, 3));
    CHECK(distance(by_factors.x, by_gradients.x) <= 1e-8);
}

TEST_CASE("implicit_newton: wrong options are refused by name", "[integrator][bad_input]") {
    Random random(8);
    const auto system = random_system<double, 2>(random);
    CHECK(missing(message_of([&] { newton(system, 0); }), {"iterations is 0", ">= 1"}).empty());
    CHECK(missing(message_of([&] { newton(system, 5, 0); }), {"tolerance is 0", "> 0"}).empty());
}

}  // namespace taut_test::implicit_newton_test
