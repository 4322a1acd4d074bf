// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/scene_dense.hpp"
#include "../support/scene_energy.hpp"
#include "../support/stepper_battery.hpp"
#include "newton_scenes.hpp"

namespace taut_test::implicit_newton_test {

using taut::Status;

namespace {

constexpr Kind cube{false, 3, Laws::hookean};

}  // namespace

TEST_CASE("implicit_newton: it keeps what steppers promise", "[newton]") {
    StepperBattery battery{[](const Scene& scene) { return newton(scene, 40, 1e-10); }, {cube}};
    battery.order = 1;
    test_stepper(battery);
}

TEST_CASE("implicit_newton: a step satisfies the nonlinear equation", "[newton]") {
    for (const Kind& kind : newton_kinds) {
        if (kind.single) continue;
        int converged = 0;
        for (std::uint32_t seed = 1; seed <= 20; ++seed) {
            for (const double h : {0.01, 0.3}) {
                INFO(kind << ", seed " << seed << ", h " << h);
                Random random(seed);
                RandomOptions options;
                options.rayleigh = seed % 2 == 0;
                options.dampers = seed % 3 != 0;
                auto scene = random_scene(random, kind, options);
                scene.pin(5);
                const auto before = random_state(random, scene);
                auto state = before;
                const bool solved(newton(scene)->step(state, h));
                if (options.rayleigh) REQUIRE(solved);
                if (!solved) continue;
                ++converged;
                const double momentum =
                    (dense_matrices(scene, before).M * flat(state.v)).cwiseAbs().maxCoeff();
                CHECK(open_impulse(scene, before, state, h).cwiseAbs().maxCoeff() <=
                      1e-8 * momentum);
                CHECK(gap(state.x, before.x + h * state.v) <= 10 * kind.rounding());
            }
        }
        CHECK(converged >= 36);
    }
}

TEST_CASE("implicit_newton: float reaches what its rounding admits", "[newton]") {
    Random random(5);
    const auto scene = random_scene(random, {true, 2});
    auto state = random_state(random, scene);
    const taut::Report report = newton(scene, 60, 1e-12)->step(state, scene.rounded(0.05), 5);
    CHECK(report);  // 1e-12 is out of reach
    CHECK(report.residual < 1e-3);
}

TEST_CASE("implicit_newton: no step ends above where it starts, and none leaves work open",
          "[newton]") {
    const double tolerance = 1e-3;
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const auto scene = random_scene(random, cube);
        auto start = random_state(random, scene);
        start.v *= log_uniform(random, 0.1, 100);
        start.v.leftCols(2).setZero();
        const double h = log_uniform(random, 0.01, 10);
        auto state = start;
        if (!newton(scene, 200, tolerance)->step(state, h)) continue;
        auto inertial = start;
        for (Index i = 2; i < scene.size(); ++i) inertial.v.col(i) += h * scene.gravity();
        inertial.x += h * inertial.v;
        const Real value = step_objective(scene, start, state, h);
        const Real most = step_objective(scene, start, inertial, h);
        CHECK(value <= most + 1e-9L * std::abs(most));
        // |v⁺ᵀr| h over the stake.
        Real open = 0, work = 0, kinetic = 0;
        const Eigen::MatrixXd f = scene.force(state);
        for (Index i = 2; i < scene.size(); ++i) {
            const Eigen::VectorXd r =
                scene.mass(i) * (state.v.col(i) - start.v.col(i)) - h * f.col(i);
            open += static_cast<Real>(state.v.col(i).dot(r));
            work += static_cast<Real>(scene.mass(i) * h * scene.gravity().dot(state.v.col(i)));
            kinetic += static_cast<Real>(scene.mass(i) * start.v.col(i).squaredNorm() / 2);
        }
        Real springs = 0;
        for (const AnySpring& spring : scene.springs()) {
            const Eigen::VectorXd dx = start.x.col(spring.b) - start.x.col(spring.a);
            springs += law_at(spring, static_cast<Real>(dx.norm())).energy;
        }
        CHECK(std::abs(open) <=
              1.001L * static_cast<Real>(tolerance) * (kinetic + springs + std::abs(work)));
    }
}

TEST_CASE("implicit_newton: too few iterations are reported and the state is untouched",
          "[newton]") {
    Random random(4);
    const auto scene = random_scene(random, cube);
    auto state = random_state(random, scene);
    const auto before = state;
    const taut::Report report = newton(scene, 2, 1e-10)->step(state, 0.1);
    CHECK(report.status == Status::not_converged);
    CHECK(report.residual > 1e-10);
    CHECK(report.solves == 2);
    CHECK(state == before);
    CHECK(newton(scene)->step(state, 0.1));
}

TEST_CASE("implicit_newton: an inexact solver converges to the same step", "[newton]") {
    Random random(6);
    const auto scene = random_scene(random, cube);
    auto by_factors = random_state(random, scene);
    auto by_gradients = by_factors;
    REQUIRE(newton(scene)->step(by_factors, 0.02, 3));
    REQUIRE(newton_by_gradients(scene)->step(by_gradients, 0.02, 3));
    CHECK(gap(by_factors.x, by_gradients.x) <= 1e-8);
}

TEST_CASE("implicit_newton: wrong options are refused by name", "[newton][bad_input]") {
    Random random(8);
    const auto scene = random_scene(random, cube);
    CHECK(missing(message_of([&] { newton(scene, 0); }), {"iterations is 0", ">= 1"}) == "");
    CHECK(missing(message_of([&] { newton(scene, 5, 0); }), {"tolerance is 0", "> 0"}) == "");
}

}  // namespace taut_test::implicit_newton_test
