// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/projective/detail/limited_memory.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/message.hpp"
#include "../support/returning_steps.hpp"
#include "../support/scene_dense.hpp"
#include "../support/scene_energy.hpp"
#include "../support/stepper_battery.hpp"
#include "projective_scenes.hpp"

namespace taut_test::projective_dynamics_test {

namespace {

constexpr Kind cube{false, 3, Laws::hookean};

/// Pins that move, gravity, dampers, Rayleigh damping; an external force with `pushed`.
Scene draw_scene(Random& random, const Kind& kind, bool pushed = true) {
    RandomOptions options;
    options.dampers = true;
    options.rayleigh = true;
    auto scene = random_scene(random, kind, options);
    if (pushed) scene.set_external_force([](const auto&, auto& f) { f.row(0).array() += 2; });
    return scene;
}

}  // namespace

TEST_CASE("projective_dynamics: it keeps what steppers promise", "[projective]") {
    StepperBattery battery{[](const Scene& scene) { return projective(scene); }, projective_kinds};
    battery.order = 1;
    test_stepper(battery);
}

TEST_CASE("projective_dynamics: its limit is the nonlinear implicit step", "[projective]") {
    for (const Kind& kind : projective_kinds) {
        if (kind.single) continue;
        for (std::uint32_t seed = 1; seed <= 4; ++seed) {
            INFO(kind << ", seed " << seed);
            Random random(seed);
            const auto scene = draw_scene(random, kind);
            auto state = scene.initial_state();  // unstretched: one minimum for short steps
            state.v = random_state(random, scene).v;
            auto plain_state = state;
            const auto plain = projective(scene, {20000, 1e-11, 0});
            const auto fast = projective(scene, {20000, 1e-11, 5});
            for (int i = 0; i < 5; ++i) {
                const auto before = state;
                REQUIRE(fast->step(state, 0.01));
                REQUIRE(plain->step(plain_state, 0.01));
                const double momentum = (state.v.colwise().norm()).maxCoeff();
                CHECK(open_impulse(scene, before, state, 0.01).cwiseAbs().maxCoeff() <=
                      1e-8 * momentum);
                CHECK(fast->iterations() <= plain->iterations());
            }
            CHECK(gap(plain_state.x, state.x) <= 1e-9);
            CHECK(plain->factorizations() == 1);
        }
    }
}

TEST_CASE("projective_dynamics: no iteration raises the step's objective", "[projective]") {
    for (const Kind& kind : projective_kinds) {
        int further = 0, of = 0;
        for (std::uint32_t seed = 1; seed <= 10; ++seed) {
            Random random(seed);
            const auto scene = draw_scene(random, kind, false);
            const auto start = random_state(random, scene);
            for (const double h : {0.01, 0.3, 3.0}) {
                auto inertial = start;
                for (Index i = 2; i < scene.size(); ++i) inertial.v.col(i) += h * scene.gravity();
                inertial.x += h * inertial.v;
                Real lowest[2];
                for (const int window : {0, 4}) {
                    Real last = step_objective(scene, start, inertial, h);
                    for (const int iterations : {1, 2, 3, 4, 5, 6, 9, 12, 20}) {
                        INFO(kind << ", seed " << seed << ", h " << h << ", window " << window
                                  << ", " << iterations << " iterations");
                        auto state = start;
                        REQUIRE(projective(scene, {iterations, 0, window})->step(state, h));
                        const Real next = step_objective(scene, start, state, h);
                        CHECK(next <= last + static_cast<Real>(kind.rounding()) * std::abs(last));
                        last = next;
                    }
                    lowest[window / 4] = last;
                }
                ++of;
                further += lowest[1] <= lowest[0];
            }
        }
        INFO(kind);
        CHECK(10 * further >= 6 * of);  // that is what the window is for
    }
}

TEST_CASE("projective_dynamics: its matrix is no less than any Hessian of the objective",
          "[projective]") {
    for (const Kind& kind : eigen_kinds) {
        for (std::uint32_t seed = 1; seed <= 60; ++seed) {
            Random random(seed);
            RandomOptions options;
            options.springs = 3;
            options.rayleigh = seed % 2 == 0;
            auto scene = random_scene(random, kind, options);
            for (int s = 0; s < 6; ++s) {
                const Index a = random.below(8);
                const Index b = (a + 1 + random.below(7)) % 8;
                scene.add_spring({a, b, 10, 0.5, log_uniform(random, 0.01, 1000)});
            }
            const auto start = random_state(random, scene);
            const double h = scene.rounded(log_uniform(random, 1e-3, 10));
            const auto stepper = projective_by_eigen(scene);
            auto moved = start;
            REQUIRE(stepper->step(moved, h));

            const Eigen::MatrixXd P = stepper->matrix();
            const auto free = free_dofs(scene);
            const auto n = static_cast<Index>(free.size());
            const auto damped = dense_matrices(scene, start);
            for (int pose = 0; pose < 10; ++pose) {
                const auto bent = dense_matrices(scene, random_state(random, scene));
                const Eigen::MatrixXd hessian =
                    (bent.M + h * damped.D + h * h * bent.K)(free, free);
                Eigen::MatrixXd excess = -hessian;
                for (Index i = 0; i < n; ++i) {
                    for (Index j = i % kind.dim; j < n; j += kind.dim)
                        excess(i, j) += P(i / kind.dim, j / kind.dim);
                }
                INFO(kind << ", seed " << seed << ", h " << h << ", pose " << pose);
                CHECK(least_eigenvalue(excess) >= -kind.rounding() * P.cwiseAbs().maxCoeff());
            }
        }
    }
}

TEST_CASE("projective_dynamics: the residual is that of the nonlinear equation", "[projective]") {
    Random random(3);
    const auto scene = draw_scene(random, cube);
    const auto start = random_state(random, scene);
    const double h = 0.02;
    double momentum = 0;
    for (Index i = 2; i < scene.size(); ++i) {
        const Eigen::Vector3d load = scene.mass(i) * scene.gravity() + Eigen::Vector3d(2, 0, 0);
        momentum += (h * scene.mass(i) * start.v.col(i) + h * h * load).squaredNorm();
    }
    for (const int iterations : {1, 4, 40}) {
        const auto stepper = projective(scene, {iterations});
        auto state = start;
        const taut::Report report = stepper->step(state, h);
        REQUIRE(report);
        CHECK(stepper->iterations() <= iterations);
        const double open = h * open_impulse(scene, start, state, h).norm();
        CHECK(report.residual <= open / std::sqrt(momentum) * (1 + 1e-9));
        CHECK(report.residual > 0);
        if (iterations == 40) CHECK(report.residual < 1e-2);
    }
}

TEST_CASE("projective_dynamics: without stiffness it is ballistic motion", "[projective]") {
    for (const Kind& kind : projective_kinds) {
        if (kind.laws != Laws::hookean) continue;
        INFO(kind);
        Random random(4);
        Scene scene(kind);
        for (int i = 0; i < 5; ++i) scene.add_particle(random_vector(random, kind.dim, -1, 1), 2);
        for (int i = 1; i < 5; ++i) scene.add_spring({0, i, 0});
        scene.set_gravity(-9.81 * Eigen::VectorXd::Unit(kind.dim, kind.dim - 1));
        const auto start = random_state(random, scene);
        auto state = start;
        const double h = scene.rounded(0.01);
        REQUIRE(projective(scene)->step(state, h, 10));
        const Eigen::VectorXd g = scene.gravity();
        const Eigen::MatrixXd v = start.v.colwise() + 10 * h * g;
        const Eigen::MatrixXd x = (start.x + 10 * h * start.v).colwise() + 55 * h * h * g;
        CHECK(gap(state.v, v) <= kind.rounding());
        CHECK(gap(state.x, x) <= kind.rounding());
    }
}

TEST_CASE("projective_dynamics: an h that returns costs no factorisation, a new scene does",
          "[projective]") {
    Random random(5);
    auto scene = random_scene(random, cube);
    auto state = random_state(random, scene);
    const auto stepper = projective(scene);
    for (const auto& [h, expected] : returning_steps) {
        REQUIRE(stepper->step(state, h, 2));
        CHECK(stepper->factorizations() == expected);
    }
    scene.set_mass(4, 7);
    REQUIRE(stepper->step(state, 0.01));
    CHECK(stepper->factorizations() == 5);
    scene.set_gravity(Eigen::Vector3d(0, 1, 0));
    REQUIRE(stepper->step(state, 0.01));
    CHECK(stepper->factorizations() == 5);
}

TEST_CASE("projective_dynamics: any of Eigen's symmetric solvers gives the same step",
          "[projective]") {
    constexpr Kind kinds[] = {{true, 2, Laws::hookean}, {false, 3, Laws::any}};
    for (const Kind& kind : kinds) {
        INFO(kind);
        Random random(6);
        const auto scene = draw_scene(random, kind);
        auto state = random_state(random, scene);
        auto by_eigen = state;
        REQUIRE(projective(scene)->step(state, 0.01, 5));
        REQUIRE(projective_by_eigen(scene)->step(by_eigen, 0.01, 5));
        CHECK(gap(state.x, by_eigen.x) <= kind.accumulated());
    }
}

TEST_CASE("projective_dynamics: wrong options are refused by name", "[projective][bad_input]") {
    Random random(7);
    const auto scene = random_scene(random, cube);
    const auto message = [&](const ProjectiveLimits& limits) {
        return message_of([&] { projective(scene, limits); });
    };
    CHECK(missing(message({0, 0, 5}), {"iterations is 0", ">= 1"}) == "");
    CHECK(missing(message({10, 0, -1}), {"window is -1", ">= 0"}) == "");
    CHECK(missing(message({10, -1, 5}), {"tolerance is -1"}) == "");
}

TEST_CASE("projective_dynamics: whatever pairs it is given, what is remembered goes downhill",
          "[projective]") {
    Random random(4711);
    for (int repeat = 0; repeat < 200; ++repeat) {
        INFO("repeat " << repeat << " of seed 4711");
        const Index n = 2 + random.below(5);
        taut::integrator_detail::LimitedMemory<Eigen::VectorXd> memory(1 + int(random.below(4)));
        for (int pair = 0; pair < 6; ++pair) {
            const Eigen::VectorXd move = random_vector(random, int(n), -1, 1);
            Eigen::VectorXd change = move + random_vector(random, int(n), -1, 1);
            if (random.below(3) == 0) change = -change;
            memory.add(move, change);
            const Eigen::VectorXd slope = random_vector(random, int(n), -1, 1);
            Eigen::VectorXd step = slope;
            memory.apply(step, [](Eigen::VectorXd&) {});
            REQUIRE(step.dot(slope) > 0);
        }
    }
}

}  // namespace taut_test::projective_dynamics_test
