// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "../support/catch.hpp"
#include "../support/scene_dense.hpp"
#include "../support/stepper_battery.hpp"
#include "bdf2_scenes.hpp"

namespace taut_test::bdf2_test {

namespace {

constexpr Kind cube{false, 3, Laws::hookean};
constexpr double declared_order = 2;

RandomOptions damped() {
    RandomOptions options;
    options.rayleigh = true;
    options.dampers = true;
    return options;
}

/// Particles on a line, `apart`, joined by springs to the next one.
Scene chain(int particles, double apart, double mass, const std::function<double(int)>& stiffness) {
    Scene scene(cube);
    for (int i = 0; i < particles; ++i) {
        scene.add_particle(apart * i * Eigen::Vector3d::UnitZ(), mass);
        if (i > 0) scene.add_spring({i - 1, i, stiffness(i), apart});
    }
    return scene;
}

/// Largest distance of the positions at three refinements, as the order they show.
double observed_order(const Scene& scene, const AnyState& start, double duration, int steps,
                      const std::vector<double>& pattern) {
    const auto end = [&](int count) {
        auto state = start;
        const auto stepper = direct_bdf2(scene);
        double sum = 0;
        for (const double part : pattern) sum += part;
        const double h = duration * static_cast<double>(pattern.size()) / (sum * count);
        for (int i = 0; i < count; ++i) {
            REQUIRE(
                stepper->step(state, h * pattern[static_cast<std::size_t>(i) % pattern.size()]));
        }
        return state;
    };
    const auto coarse = end(steps);
    const auto middle = end(2 * steps);
    const auto fine = end(4 * steps);
    return std::log2((coarse.x - middle.x).norm() / (middle.x - fine.x).norm());
}

}  // namespace

TEST_CASE("bdf2: it keeps what steppers promise", "[bdf2]") {
    test_stepper(
        {[](const Scene& scene) { return bdf2(scene); }, bdf2_kinds, direct_bdf2, linear_bdf2});
}

TEST_CASE("bdf2: the first step is implicit Euler's", "[bdf2]") {
    for (const Kind& kind : direct_bdf2_kinds) {
        INFO(kind);
        Random random(1);
        const auto scene = random_scene(random, kind, damped());
        const auto before = random_state(random, scene);
        auto state = before;
        const double h = 0.0625;
        REQUIRE(direct_bdf2(scene)->step(state, h));
        // (M + hD + h²K⁺)(v⁺ − v) = h(f(x, v) − hK⁺v) on the free particles.
        const auto dense = dense_matrices(scene, before);
        const Eigen::MatrixXd A = dense.M + h * dense.D + h * h * dense.K_plus;
        const Eigen::VectorXd b =
            h * (flat_force(scene, before) - h * dense.K_plus * flat(before.v));
        const auto free = free_dofs(scene);
        const Eigen::VectorXd left = (A * (flat(state.v) - flat(before.v)))(free);
        CHECK(gap(left, b(free)) <= kind.accumulated() * b.cwiseAbs().maxCoeff());
        CHECK(gap(state.x, before.x + h * state.v) <= kind.rounding());
    }
}

TEST_CASE("bdf2: a step satisfies its own update equation, at equal and unequal steps", "[bdf2]") {
    for (const Kind& kind : direct_bdf2_kinds) {
        for (const double ratio : {1.0, 0.25, 2.0}) {
            INFO(kind << ", ratio " << ratio);
            Random random(2);
            const auto scene = random_scene(random, kind, damped());
            const auto before = random_state(random, scene);
            auto state = before;
            const auto stepper = direct_bdf2(scene);
            REQUIRE(stepper->step(state, 0.0625));
            const auto now = state;
            const double h = ratio * 0.0625;
            const taut::Report report = stepper->step(state, h);
            REQUIRE(report);
            CHECK(report.residual < kind.accumulated());

            // Differentiating the parabola through three times gives these weights.
            const double next = (1 + 2 * ratio) / (1 + ratio);
            const double past = ratio * ratio / (1 + ratio);
            const auto rate = [&](Eigen::MatrixXd AnyState::*of) {
                return flat((next * state.*of - (1 + ratio) * now.*of + past * before.*of) / h);
            };
            const auto dense = dense_matrices(scene, now);
            const auto free = free_dofs(scene);
            const Eigen::VectorXd force = flat_force(scene, now) -
                                          dense.K_plus * (flat(state.x) - flat(now.x)) -
                                          dense.D * (flat(state.v) - flat(now.v));
            const Eigen::VectorXd inertia = dense.M * rate(&AnyState::v);
            CHECK(gap(inertia(free), force(free)) <=
                  kind.accumulated() * inertia.cwiseAbs().maxCoeff());
            CHECK(gap(rate(&AnyState::x), flat(state.v)) <=
                  kind.accumulated() * state.v.cwiseAbs().maxCoeff());
        }
    }
}

TEST_CASE("bdf2: order 2 while no spring is compressed, at equal and unequal steps", "[bdf2]") {
    const auto scene = smooth_scene(cube);
    const auto start = scene.initial_state();
    auto state = start;
    const auto stepper = direct_bdf2(scene);
    for (int i = 0; i < 50; ++i) {
        REQUIRE(stepper->step(state, 0.004));
        for (const AnySpring& spring : scene.springs())
            CHECK((state.x.col(spring.b) - state.x.col(spring.a)).norm() > spring.rest_length);
    }
    CHECK_THAT(observed_order(scene, start, 0.2, 200, {1}), WithinAbs(declared_order, 0.05));
    CHECK_THAT(observed_order(scene, start, 0.2, 200, {1, 0.5, 0.9, 0.8}),
               WithinAbs(declared_order, 0.05));
}

TEST_CASE("bdf2: a compressed spring's transverse part lags: order 1", "[bdf2]") {
    Random random(3);
    const auto scene = random_scene(random, cube);
    const auto start = random_state(random, scene);
    const double order = observed_order(scene, start, 0.05, 400, {1});
    CHECK(order > 0.9);
    CHECK(order < 1.5);
}

TEST_CASE("bdf2: a step more than twice its predecessor, or after a failure, starts anew",
          "[bdf2]") {
    Random random(4);
    const auto scene = random_scene(random, cube);
    const auto start = random_state(random, scene);
    for (const double h : {0.001, 0.002, 0.0021}) {
        for (const bool failed : {false, true}) {
            INFO("h " << h << ", failed " << failed);
            auto used = start;
            const auto stepper = direct_bdf2(scene);
            REQUIRE(stepper->step(used, 0.001, 3));
            auto fresh = used;
            if (failed) {
                const double nan = std::numeric_limits<double>::quiet_NaN();
                CHECK(stepper->step(used, nan).status == taut::Status::invalid_step);
                CHECK(used == fresh);
            }
            REQUIRE(stepper->step(used, h));
            REQUIRE(direct_bdf2(scene)->step(fresh, h));
            CHECK((used == fresh) == (failed || h > 0.002));
        }
    }
}

TEST_CASE("bdf2: the artificial damping ratio of a mode is (h omega)^3/4", "[bdf2]") {
    auto oscillator = chain(2, 1, 1, [](int) { return 4; });
    oscillator.pin(0);
    for (const double z : {0.05, 0.1}) {  // hω, ω = 2/s
        auto state = oscillator.initial_state();
        state.x(2, 1) += 0.0625;
        const auto stepper = direct_bdf2(oscillator);
        const auto swing = [&] { return std::hypot(state.x(2, 1) - 1, state.v(2, 1) / 2); };
        REQUIRE(stepper->step(state, z / 2, 10));  // past the first step
        const double before = swing();
        const int steps = static_cast<int>(2 / (z * z * z));
        REQUIRE(stepper->step(state, z / 2, steps));
        const double ratio = std::log(before / swing()) / (steps * z);
        CHECK_THAT(ratio, WithinRel(z * z * z / 4, 0.05));
    }
}

TEST_CASE("bdf2: conjugate gradients take the direct solver's steps, and their cap is reported",
          "[bdf2]") {
    Random random(12);
    const auto scene = random_scene(random, cube);
    auto by_factors = random_state(random, scene);
    auto by_gradients = by_factors;
    REQUIRE(direct_bdf2(scene)->step(by_factors, 0.02, 5));
    REQUIRE(bdf2(scene, 1e-12)->step(by_gradients, 0.02, 5));
    CHECK(gap(by_factors.v, by_gradients.v) <= 1e-9 * by_factors.v.cwiseAbs().maxCoeff());

    // Over twelve decades of stiffness they do not reach 1e-13 within their cap.
    auto stiff = chain(20, 1, 1e-4, [](int i) { return std::pow(1e12, (i * 7 % 20) / 20.0); });
    stiff.set_gravity(Eigen::Vector3d::UnitZ());
    auto state = stiff.initial_state();
    const auto before = state;
    CHECK(bdf2(stiff, 1e-13)->step(state, 1.0).status == taut::Status::not_converged);
    CHECK(state == before);
}

TEST_CASE("bdf2: more of a swing's energy survives than with implicit Euler at the same step",
          "[bdf2]") {
    // A chain of eight links swings for two seconds. Up to this stiffness: beyond, what the one
    // linearised solve leaves out of a turning link costs both methods nearly everything.
    for (const double stiffness : {10.0, 100.0, 1e3, 1e4}) {
        auto links = chain(9, 0.1, 0.01, [&](int) { return stiffness; });
        links.pin(0);
        links.set_gravity(9.81 * Eigen::Vector3d(std::sin(0.5), 0, std::cos(0.5)));
        const auto lost = [&](std::unique_ptr<AnyStepper> stepper) {
            auto state = links.initial_state();
            const double start = links.energy(state);
            REQUIRE(stepper->step(state, 1.0 / 60, 120));
            return start - links.energy(state);
        };
        const double by_euler = lost(links.stepper(taut::Method::implicit_euler));
        const double by_bdf2 = lost(bdf2(links));
        INFO("stiffness " << stiffness << ": lost " << by_euler << " J and " << by_bdf2 << " J");
        CHECK(by_bdf2 < 0.8 * by_euler);
    }
}

}  // namespace taut_test::bdf2_test
