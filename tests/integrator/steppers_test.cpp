// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/scene_dense.hpp"
#include "../support/stepper_battery.hpp"
#include "stepper_scenes.hpp"

// The core's steppers on scenes. What an implicit step solves: implicit_euler_test.cpp.

namespace taut_test::steppers_test {

using taut::Method;

namespace {

/// Of some kinds of Hookean springs through matrices, too.
StepperBattery battery(Method method, Laws laws, bool matrices = false) {
    StepperBattery battery;
    battery.make = [=](const Scene& scene) { return scene.stepper(method); };
    if (method == Method::implicit_euler) battery.exact = exact_implicit_euler;
    battery.kinds = matrices ? matrix_kinds : kinds_of(laws);
    if (matrices)
        battery.linear = [=](const Scene& scene) { return through_matrices(scene, method); };
    if (laws == Laws::hookean) battery.order = method == Method::velocity_verlet ? 2 : 1;
    battery.diverges = method != Method::implicit_euler && laws != Laws::strings;
    return battery;
}

RandomOptions damped() {
    RandomOptions options;
    options.rayleigh = options.dampers = true;
    return options;
}

Eigen::MatrixXd accelerations(const Scene& scene, const AnyState& state) {
    Eigen::MatrixXd a = scene.force(state);
    for (Index i = 0; i < scene.size(); ++i) a.col(i) *= scene.is_pinned(i) ? 0 : 1 / scene.mass(i);
    return a;
}

double largest(const Eigen::MatrixXd& a) { return a.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("steppers: what explicit Euler promises", "[integrator]") {
    test_stepper(battery(Method::explicit_euler, Laws::hookean, GENERATE(false, true)));
}
TEST_CASE("steppers: what symplectic Euler promises", "[integrator]") {
    test_stepper(battery(Method::symplectic_euler, Laws::hookean, GENERATE(false, true)));
}
TEST_CASE("steppers: what velocity Verlet promises", "[integrator]") {
    test_stepper(battery(Method::velocity_verlet, Laws::hookean, GENERATE(false, true)));
}
TEST_CASE("steppers: what implicit Euler promises", "[integrator]") {
    test_stepper(battery(Method::implicit_euler, Laws::hookean, GENERATE(false, true)));
}
TEST_CASE("steppers: what energy-stable Euler promises", "[integrator]") {
    test_stepper(battery(Method::energy_stable_euler, Laws::hookean));
}
TEST_CASE("steppers: what they promise with springs of other laws", "[integrator]") {
    const auto laws = GENERATE(Laws::strings, Laws::mixed, Laws::any);
    const auto method = GENERATE(Method::velocity_verlet, Method::energy_stable_euler,
                                 Method::symplectic_euler, Method::implicit_euler);
    const bool made = laws != Laws::any || method == Method::velocity_verlet ||
                      method == Method::energy_stable_euler;
    if (made) test_stepper(battery(method, laws));
}

TEST_CASE("steppers: an explicit step satisfies its own update equation", "[integrator]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (const Method method :
             {Method::explicit_euler, Method::symplectic_euler, Method::velocity_verlet}) {
            Random random(1);
            const Scene scene = random_scene(random, kind, damped());
            auto state = random_state(random, scene);
            const double h = 0.03125;
            const auto stepper = scene.stepper(method);
            for (int step = 0; step < 3; ++step) {  // Verlet's later ones use a force kept
                INFO(kind << ", " << static_cast<int>(method) << ", step " << step);
                const auto before = state;
                const taut::Report report = stepper->step(state, h);
                REQUIRE(report);
                CHECK(report.residual == 0);
                CHECK(state.time == before.time + h);
                Eigen::MatrixXd v = before.v + h * accelerations(scene, before);
                double tolerance = kind.rounding();
                if (method == Method::velocity_verlet) {
                    // v½ = v + ½h M⁻¹f(x, v') with v' = the velocity that f was last evaluated
                    // with.
                    auto half = before;
                    half.x = state.x;
                    half.v = (state.x - before.x) / h;
                    tolerance *= 100;
                    v = (before.v + v) / 2;
                    if (step == 0) CHECK(gap(half.v, v) <= tolerance * largest(v));
                    v = half.v + h / 2 * accelerations(scene, half);
                } else {
                    const auto& by = method == Method::explicit_euler ? before.v : v;
                    CHECK(gap(state.x, before.x + h * by) <= tolerance * largest(v));
                }
                CHECK(gap(state.v, v) <= tolerance * largest(v));
            }
        }
    }
}

TEST_CASE("steppers: an undamped mode grows by sqrt(1 + z^2) a step, or decays by as much",
          "[integrator]") {
    for (const bool single : {false, true}) {
        Scene scene({single, 1, Laws::hookean});
        scene.add_particle(Eigen::VectorXd::Zero(1), 1);
        scene.add_particle(Eigen::VectorXd::Ones(1), 1);
        scene.add_spring({0, 1, 4, 1});
        scene.pin(0);
        for (const bool grows : {true, false}) {
            auto state = scene.initial_state();
            state.x(0, 1) += 0.0625;
            const auto stepper =
                grows ? scene.stepper(Method::explicit_euler) : exact_implicit_euler(scene);
            REQUIRE(stepper->step(state, 0.125, 64));
            const double size = std::hypot(state.x(0, 1) - 1, state.v(0, 1) / 2);
            CHECK_THAT(size, WithinRel(0.0625 * std::pow(1 + 0.0625, grows ? 32 : -32),
                                       scene.kind().accumulated()));
        }
    }
}

TEST_CASE("steppers: at half its limit symplectic Euler keeps energy within a factor of 3",
          "[integrator]") {
    // v'Mv + x'Kx - h v'Kx is kept exactly; its last term is at most h sqrt(k_max)/2 of the others.
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        INFO(kind);
        Scene scene = linear_scene(kind, false);  // at rest where all are at its one pin
        scene.set_gravity(Eigen::VectorXd::Zero(kind.dim));
        Random random(3);
        auto state = random_state(random, scene);
        state.v.col(3).setZero();
        const auto dense = dense_matrices(scene, state);
        const auto free = free_dofs(scene);
        const Eigen::VectorXd scale = dense.M.diagonal()(free).cwiseSqrt().cwiseInverse();
        const auto k = spectrum(scale.asDiagonal() * Eigen::MatrixXd(dense.K(free, free)) *
                                scale.asDiagonal());
        const double h = scene.rounded(1 / std::sqrt(k[k.size() - 1]));
        const double first = scene.energy(state);
        const auto stepper = scene.stepper(Method::symplectic_euler);
        for (int i = 0; i < 2000; ++i) {
            REQUIRE(stepper->step(state, h));
            REQUIRE(scene.energy(state) <= 3 * first * (1 + kind.accumulated()));
            REQUIRE(scene.energy(state) >= first / 3 * (1 - kind.accumulated()));
        }
    }
}

TEST_CASE("steppers: angular momentum is kept to rounding, axial dampers included",
          "[integrator]") {
    for (const Kind& kind : all_kinds()) {
        if (kind.dim < 3) continue;
        for (const Method method : {Method::symplectic_euler, Method::velocity_verlet}) {
            if (kind.laws == Laws::any && method == Method::symplectic_euler) continue;
            INFO(kind);
            Random random(4);
            RandomOptions options;
            options.pinned = 0;
            options.gravity = false;
            options.dampers = true;
            const Scene scene = random_scene(random, kind, options);
            auto state = random_state(random, scene);
            const auto momentum = [&] {
                Eigen::Vector3d sum = Eigen::Vector3d::Zero();
                for (Index i = 0; i < scene.size(); ++i) {
                    sum += scene.mass(i) *
                           Eigen::Vector3d(state.x.col(i)).cross(Eigen::Vector3d(state.v.col(i)));
                }
                return sum;
            };
            const Eigen::Vector3d before = momentum();
            REQUIRE(scene.stepper(method)->step(state, scene.rounded(0.001), 400));
            CHECK(gap(momentum(), before) <= kind.accumulated());
        }
    }
}

TEST_CASE("steppers: the external force is asked once a step, for the state of its start",
          "[integrator]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (const Method method :
             {Method::explicit_euler, Method::symplectic_euler, Method::implicit_euler}) {
            INFO(kind << ", " << static_cast<int>(method));
            Random random(5);
            Scene scene = random_scene(random, kind);
            auto state = random_state(random, scene);
            auto expected = state;
            int calls = 0;
            scene.set_external_force([&](const AnyState& given, Eigen::MatrixXd& f) {
                CHECK(given == expected);
                CHECK(f.cols() == given.x.cols());
                ++calls;
            });
            const auto stepper = scene.stepper(method);
            for (int i = 0; i < 5; ++i) {
                REQUIRE(stepper->step(state, scene.rounded(0.001)));
                expected = state;
            }
            CHECK(calls == 5);
        }
    }
}

TEST_CASE("steppers: a force that is not finite is reported with its particle", "[integrator]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (const Method method : {Method::symplectic_euler, Method::implicit_euler}) {
            INFO(kind << ", " << static_cast<int>(method));
            Random random(6);
            Scene scene = random_scene(random, kind);
            scene.set_external_force(
                [](const auto&, auto& f) { f(0, 5) = std::numeric_limits<double>::quiet_NaN(); });
            auto state = random_state(random, scene);
            const auto before = state;
            const taut::Report report = scene.stepper(method)->step(state, scene.rounded(0.001), 3);
            CHECK_FALSE(report);
            CHECK(report.iterations == 0);
            CHECK(state == before);
            if (method == Method::implicit_euler) {  // the solve spreads it
                CHECK((report.where >= 2 && report.where < scene.size()));
            } else {
                CHECK(report.status == taut::Status::diverged);
                CHECK(report.where == 5);
            }
        }
    }
}

TEST_CASE("steppers: velocity Verlet is undone by steps with the velocity turned round",
          "[integrator]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        INFO(kind);
        const Scene scene = smooth_scene(kind);
        Random random(2);
        auto state = scene.initial_state();
        state.v = random_points(random, kind.dim, 6, -1, 1);
        const auto start = state;
        const auto stepper = scene.stepper(Method::velocity_verlet);
        REQUIRE(stepper->step(state, scene.rounded(0.01), 100));
        state.v *= -1;
        REQUIRE(stepper->step(state, scene.rounded(0.01), 100));
        CHECK(gap(state.x, start.x) <= kind.accumulated());
        CHECK(gap(state.v, -start.v) <= kind.accumulated());
    }
}

TEST_CASE("steppers: velocity Verlet that goes on with a step that overflows says so",
          "[integrator]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Scene scene(kind);  // its velocity, of a force that there is not, is all that moves it
        scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
        auto state = scene.initial_state();
        state.v.setConstant(1e5);
        const auto stepper = scene.stepper(Method::velocity_verlet);
        REQUIRE(stepper->step(state, scene.rounded(0.01), 3));
        const auto before = state;
        const auto report = stepper->step(state, kind.single ? 1e36 : 1e306, 1);
        CHECK(report.status == taut::Status::diverged);
        CHECK(state == before);
    }
}

TEST_CASE("steppers: velocity Verlet's force is evaluated once a step, and again if it was edited",
          "[integrator]") {
    Random random(3);
    Scene scene = random_scene(random, {false, 2, Laws::hookean});
    int calls = 0;
    scene.set_external_force([&](const auto&, auto&) { ++calls; });
    auto state = random_state(random, scene);
    const auto stepper = scene.stepper(Method::velocity_verlet);
    const auto evaluations = [&](Index count) {
        calls = 0;
        REQUIRE(stepper->step(state, 0.001, count));
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
    scene.set_mass(3, 1);
    CHECK(evaluations(10) == 11);
    CHECK(evaluations(10) == 10);

    calls = 0;  // a failed call forgets the force
    CHECK_FALSE(stepper->step(state, -1));
    CHECK(calls == 0);
    CHECK(evaluations(1) == 2);
}

TEST_CASE("steppers: after a step from a spring of no length they go on as one that is new",
          "[integrator]") {
    // Which is not the sweep's: what it kept from an earlier step is of another state.
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (const Method method : {Method::symplectic_euler, Method::velocity_verlet}) {
            INFO(kind << ", " << static_cast<int>(method));
            Random random(10);
            Scene scene = random_scene(random, kind);
            scene.add_spring({4, 5, 100, 0.5});
            auto state = random_state(random, scene);
            const auto stepper = scene.stepper(method);
            const double h = scene.rounded(0.001);
            REQUIRE(stepper->step(state, h));
            state.x.col(4) = state.x.col(5);
            for (int i = 0; i < 3; ++i) {
                auto expected = state;
                REQUIRE(scene.stepper(method)->step(expected, h));
                REQUIRE(stepper->step(state, h));
                CHECK(gap(state.v, expected.v) <= kind.rounding() * largest(expected.v));
            }
        }
    }
}

TEST_CASE("steppers: velocity Verlet takes a force of time at the step's end: order 2 there, too",
          "[integrator]") {
    Scene scene({false, 1, Laws::hookean});
    scene.add_particle(Eigen::VectorXd::Zero(1), 1);
    scene.set_external_force([](const auto& state, auto& f) { f(0, 0) += std::cos(state.time); });
    const auto error = [&](int steps) {
        auto state = scene.initial_state();
        REQUIRE(scene.stepper(Method::velocity_verlet)->step(state, 1.0 / steps, steps));
        return std::abs(state.v(0, 0) - std::sin(1.0));
    };
    CHECK_THAT(std::log2(error(200) / error(400)), WithinAbs(2, 0.05));
}

}  // namespace taut_test::steppers_test
