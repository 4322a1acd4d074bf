// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "../support/catch.hpp"
#include "../support/methods.hpp"
#include "extreme_scene.hpp"
#include "steppers.hpp"

// A step from anywhere, of any size: a finite state, or a Report and the state as it was.

namespace taut_test::extreme_step_test {

using taut::Method;

namespace {

void check_step(std::unique_ptr<AnyStepper> stepper, const AnyState& start, double h) {
    auto state = start;
    const taut::Report report = stepper->step(state, h, 3);
    INFO(describe(report.status));
    if (report) {
        CHECK((state.x.allFinite() && state.v.allFinite()));
    } else {
        CHECK(state == start);
    }
}

void check_core(const Scene& scene, const AnyState& start, double h) {
    for (const Method method : all_methods) {
        if (method == Method::bdf2) continue;  // of two dimensions, below
        INFO(name(method));
        check_step(scene.stepper(method), start, h);
    }
}

/// Of two dimensions.
void check_all(const Scene& scene, const AnyState& start, double h) {
    check_core(scene, start, h);
    check_step(bdf2(scene), start, h);
    check_step(projective_dynamics(scene), start, h);
}

}  // namespace

TEST_CASE("extremes: a step leaves a finite state, or a Report and the state as it was",
          "[extremes]") {
    for (const bool single : {true, false}) {
        Random random(1520);
        for (int repeat = 0; repeat < 200; ++repeat) {
            const Kind kind{single, 2, Laws::hookean};
            const auto scene = extreme_scene(random, kind, repeat % 2 == 1);
            auto state = random_state(random, scene);
            if (repeat % 3 == 0) state.x.array() += 1e8;
            if (repeat % 5 == 0) state.x.col(0) = state.x.col(1);
            if (repeat % 7 == 0) state.v *= 1e30;
            const auto round = [&](double y) { return scene.rounded(y); };
            state.x = state.x.unaryExpr(round).eval();
            state.v = state.v.unaryExpr(round).eval();
            const double h = log_uniform(random, 1e-12, 1e6);
            CAPTURE(kind, repeat, h);
            check_all(scene, state, h);
        }
    }
}

TEST_CASE("extremes: a chain of 100 000 masses, condition 1e10", "[extremes][slow]") {
    const Index n = 100'000;
    for (const int dim : {2, 3}) {
        Scene chain({false, dim, Laws::hookean});
        CAPTURE(chain.kind());
        for (Index i = 0; i <= n; ++i) {
            chain.add_particle(static_cast<double>(i) * Eigen::VectorXd::Unit(dim, 0), 1);
            if (i > 0) chain.add_spring({i - 1, i, 1, 1});
        }
        chain.pin(0);
        const auto start = chain.initial_state();
        const auto limit = chain.limit(Method::symplectic_euler, start);
        const double half_angle = (2.0 * n - 1) * std::acos(-1.0) / (2 * (2.0 * n + 1));
        const double truth = 1 / std::sin(half_angle);  // 2/√k_max, k_max = 4 sin²
        CHECK(limit.certified <= truth);
        CHECK(limit.refuted >= truth);
        for (const double h : {0.9, 1e6})
            dim == 2 ? check_all(chain, start, h) : check_core(chain, start, h);
    }
}

}  // namespace taut_test::extreme_step_test
