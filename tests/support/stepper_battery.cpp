// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "stepper_battery.hpp"

#include <cmath>

#include "catch.hpp"
#include "faults.hpp"

namespace taut_test {

namespace {

using Change = std::function<void(Scene&, AnyState&)>;

/// A spring of the kind's first law.
AnySpring spring_between(const Scene& scene, Index a, Index b, double stiffness,
                         double rest_length = 0) {
    AnySpring spring{a, b, stiffness, rest_length};
    spring.law = laws_of(scene.kind())[0];
    return spring;
}

RandomOptions damped_options() {
    RandomOptions options;
    options.rayleigh = true;
    options.dampers = true;
    return options;
}

void check_counted_steps(const StepperBattery& battery, const Kind& kind) {
    Random random(20);
    const auto scene = random_scene(random, kind, damped_options());
    const auto start = random_state(random, scene);
    const double h = scene.rounded(0.001);
    auto at_once = start;
    auto singly = start;
    const auto one = battery.make(scene);
    const auto many = battery.make(scene);
    const taut::Report report = many->step(at_once, h, 50);
    REQUIRE(report);
    CHECK(report.iterations == 50);
    CHECK(report.where == -1);
    for (int i = 0; i < 50; ++i) REQUIRE(one->step(singly, h));
    CHECK(at_once == singly);
    CHECK_THAT(at_once.time, WithinRel(0.05, kind.accumulated()));
    // The same stepper, used again from the start, gives the same bits again.
    auto again = start;
    REQUIRE(many->step(again, h, 50));
    CHECK(again == at_once);
    // No step is a step too.
    REQUIRE(many->step(again, h, 0));
    CHECK(again == at_once);
}

void check_bad_input(const StepperBattery& battery, const Kind& kind) {
    using Limits = std::numeric_limits<double>;
    Random random(21);
    const auto scene = random_scene(random, kind);
    const auto start = random_state(random, scene);
    const auto stepper = battery.make(scene);
    const auto refused = [&](AnyState state, double h, taut::Status status, Index where) {
        const auto before = state;
        const taut::Report report = stepper->step(state, h, 3);
        CHECK(report.status == status);
        CHECK(report.iterations == 0);
        CHECK(report.where == where);
        return before.x.size() != state.x.size() ||
               (before.x.array() == state.x.array() || before.x.array().isNaN()).all();
    };
    for (const double h :
         {0.0, -0.01, Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
        CHECK(refused(start, h, taut::Status::invalid_step, -1));
        auto state = start;
        CHECK_FALSE(stepper->step(state, h, 3));
        CHECK(state == start);
    }
    for (const bool of_x : {true, false}) {
        auto state = start;
        REQUIRE(stepper->step(state, 1e-4));  // it may remember the state that it left
        auto& part = of_x ? state.x : state.v;
        part.conservativeResize(Eigen::NoChange, scene.size() - 1);
        const auto before = state;
        CHECK(stepper->step(state, 0.01).status == taut::Status::invalid_state);
        CHECK(state == before);
        for (const double bad : {Limits::quiet_NaN(), Limits::infinity()}) {
            state = start;
            (of_x ? state.x : state.v)(0, 2) = bad;
            const taut::Report report = stepper->step(state, 0.01);
            CHECK(report.status == taut::Status::invalid_state);
            CHECK(report.where == 2);
            (of_x ? state.x : state.v)(0, 2) = (of_x ? start.x : start.v)(0, 2);
            CHECK(state == start);
        }
    }
    auto state = start;
    CHECK(stepper->step(state, 0.001));  // none of it has broken the stepper
}

void check_divergence(const StepperBattery& battery, const Kind& kind) {
    Random random(22);
    Scene scene(kind);
    for (int i = 0; i < 5; ++i) {
        Eigen::VectorXd x = Eigen::VectorXd::Zero(kind.dim);
        x[0] = i;
        scene.add_particle(x, 1);
        if (i > 0) scene.add_spring(spring_between(scene, i - 1, i, 1e6, 1));
    }
    scene.pin(0);
    scene.pin(4);
    auto state = random_state(random, scene);
    state.time = 1.5;
    const auto before = state;
    const auto stepper = battery.make(scene);
    const taut::Report report = stepper->step(state, 1, 100000);
    CHECK(report.status == taut::Status::diverged);
    CHECK(report.iterations > 0);
    CHECK(report.iterations < 100000);
    CHECK(report.where >= 0);
    CHECK(report.where < scene.size());
    CHECK(state == before);
    const double h = scene.rounded(1e-4);
    CHECK(stepper->step(state, h));
    CHECK(state.time == scene.rounded(1.5 + h));
}

/// Pinned particles go on with the velocity that the state gives them, to rounding.
void check_pins(const StepperBattery& battery, const Kind& kind) {
    Random random(23);
    auto scene = random_scene(random, kind, damped_options());
    scene.set_external_force([](const auto&, auto& f) { f.array() += 5; });
    auto state = random_state(random, scene);
    const auto start = state;
    REQUIRE(battery.make(scene)->step(state, scene.rounded(0.001), 40));
    const auto drift = [&](Index i) {
        return gap(state.x.col(i), start.x.col(i) + 0.04 * start.v.col(i));
    };
    for (Index i = 0; i < 2; ++i) {
        CHECK(state.v.col(i) == start.v.col(i));
        CHECK(drift(i) <= kind.rounding());
    }
    CHECK(drift(2) > 1e-4);  // others do not
}

void check_momentum(const StepperBattery& battery, const Kind& kind) {
    Random random(24);
    RandomOptions options;
    options.pinned = 0;
    options.gravity = false;
    options.dampers = true;
    auto scene = random_scene(random, kind, options);
    scene.set_rayleigh(0, 0.0078125);
    auto state = random_state(random, scene);
    Eigen::VectorXd mass(scene.size());
    for (Index i = 0; i < scene.size(); ++i) mass[i] = scene.mass(i);
    const Eigen::VectorXd before = state.v * mass;
    const auto stepper = battery.exact ? battery.exact(scene) : battery.make(scene);
    REQUIRE(stepper->step(state, scene.rounded(0.001), 400));
    CHECK(gap(state.v * mass, before) <= kind.accumulated());
}

/// Through a SpringSystem and through its LinearSystem: the same trajectory of a linear scene.
void check_linear_scene(const StepperBattery& battery, const Kind& kind) {
    for (const bool damped : {true, false}) {
        const auto scene = linear_scene(kind, damped);
        Random random(25);
        auto state = random_state(random, scene);
        state.v.col(3).setZero();  // the pinned one
        state.x.col(3) = scene.initial_state().x.col(3);
        auto by_matrices = state;
        const double h = scene.rounded(0.005);
        const auto stepper = battery.exact ? battery.exact(scene) : battery.make(scene);
        REQUIRE(stepper->step(state, h, 200));
        REQUIRE(battery.linear(scene)->step(by_matrices, h, 200));
        CHECK(gap(state.x, by_matrices.x) <= kind.accumulated());
        CHECK(gap(state.v, by_matrices.v) <= kind.accumulated() * 10);
        CHECK(state.time == by_matrices.time);
    }
}

/// A stepper that has made steps takes up changes of the system: the next step is that of a new
/// one.
void check_takes_up(const StepperBattery& battery, const Kind& kind) {
    const auto axis = [&](int i, double size) {
        Eigen::VectorXd v = Eigen::VectorXd::Zero(kind.dim);
        v[i % kind.dim] = size;
        return v;
    };
    const Change changes[] = {
        [](Scene& scene, AnyState&) { scene.add_spring(spring_between(scene, 2, 7, 300)); },
        [](Scene& scene, AnyState&) { scene.add_spring(spring_between(scene, 0, 1, 300)); },
        [](Scene& scene, AnyState&) { scene.remove_spring(laws_of(scene.kind())[0], 3); },
        [](Scene& scene, AnyState&) { scene.unpin(1); },
        [](Scene& scene, AnyState&) { scene.pin(4); },
        [](Scene& scene, AnyState&) { scene.set_mass(4, 7); },
        [](Scene& scene, AnyState&) { scene.set_rayleigh(1, 0); },
        [&](Scene& scene, AnyState&) { scene.set_gravity(axis(1, 50)); },
        [&](Scene& scene, AnyState&) { scene.set_constant_force(4, axis(0, 50)); },
        [](Scene& scene, AnyState&) {
            scene.set_external_force([](const auto&, auto& f) { f.array() += 25; });
        },
        [](Scene&, AnyState& state) { state.x(0, 4) += 0.25; },
        [](Scene&, AnyState& state) { state.v(0, 4) += 2; },
        [&](Scene& scene, AnyState& state) {
            scene.add_particle(axis(2, 1), 1);
            scene.add_spring(spring_between(scene, 8, 3, 100));
            const auto before = state;
            state = scene.initial_state();
            state.x.leftCols(8) = before.x;
            state.v.leftCols(8) = before.v;
        },
    };
    int number = 0;
    for (const Change& change : changes) {
        INFO("change " << number++);
        Random random(26);
        RandomOptions options;
        options.rayleigh = true;
        auto scene = random_scene(random, kind, options);
        auto state = random_state(random, scene);
        const double h = scene.rounded(0.001);
        const auto used = battery.make(scene);
        REQUIRE(used->step(state, h, 5));
        auto unchanged = state;
        REQUIRE(used->step(unchanged, h, 2));
        change(scene, state);
        auto expected = state;
        REQUIRE(used->step(state, h, 2));
        REQUIRE(battery.make(scene)->step(expected, h, 2));
        CHECK(state == expected);
        if (number != 2) CHECK_FALSE(state == unchanged);  // but by a spring between two pins
    }
}

/// No particles, or all of them pinned: nothing to solve for, and no failure.
void check_nothing_free(const StepperBattery& battery, const Kind& kind) {
    const Scene empty(kind);
    auto state = empty.initial_state();
    const double h = empty.rounded(0.01);
    REQUIRE(battery.make(empty)->step(state, h, 3));
    CHECK_THAT(state.time, WithinRel(0.03, kind.rounding()));

    Random random(27);
    RandomOptions options;
    options.pinned = options.particles;
    const auto pinned = random_scene(random, kind, options);
    auto moving = random_state(random, pinned);
    const auto start = moving;
    REQUIRE(battery.make(pinned)->step(moving, h, 3));
    CHECK(gap(moving.x, start.x + 0.03 * start.v) <= kind.rounding());
    CHECK(moving.v == start.v);
}

/// Damped, undamped, without springs, with drag alone, pressed to a point, with nothing free.
void check_faults(const StepperBattery& battery, const Kind& kind) {
    Random random(28);
    Scene loose(kind);
    for (int i = 0; i < 3; ++i) loose.add_particle(Eigen::VectorXd::Constant(kind.dim, i), 1);
    Scene pressed = loose;
    pressed.add_particle(Eigen::VectorXd::Constant(kind.dim, 2), 0.5);
    pressed.add_spring(spring_between(pressed, 0, 1, 100, 4));
    pressed.add_spring(spring_between(pressed, 2, 3, 50, 0.1));
    pressed.add_spring(spring_between(pressed, 1, 3, 0, 1));
    pressed.pin(0);
    Scene drag = loose, held = pressed;
    drag.set_rayleigh(0.5, 0);
    for (Index i = 0; i < held.size(); ++i) held.pin(i);
    for (const Scene& scene : {random_scene(random, kind, damped_options()), smooth_scene(kind),
                               loose, drag, pressed, held}) {
        const auto stepper = battery.make(scene);
        auto state = scene.initial_state();
        const double h = scene.rounded(0.001);
        for (const Index count : {3, 1}) {
            taut::Report report;
            CHECK(faults_of([&] { report = stepper->step(state, h / 2, count); }) == 0);
            CHECK(report);
        }
    }
}

/// log2 of the ratio of errors at h and h/2, against a fine reference that the library's steppers
/// have no part in: the classical Runge-Kutta method.
double measured_order(const StepperBattery& battery) {
    const auto scene = smooth_scene({false, 3, Laws::hookean});
    const auto start = scene.initial_state();
    const double duration = 0.5;
    auto reference = start;
    const auto derivative = [&](const AnyState& w) {
        AnyState rate{w.v, scene.force(w)};
        for (Index i = 0; i < scene.size(); ++i) {
            if (scene.is_pinned(i)) {
                rate.v.col(i).setZero();
            } else {
                rate.v.col(i) /= scene.mass(i);
            }
        }
        return rate;
    };
    const auto moved = [&](const AnyState& rate, double h) {
        return AnyState{reference.x + h * rate.x, reference.v + h * rate.v};
    };
    const int fine = 1000;
    for (int i = 0; i < fine; ++i) {
        const double h = duration / fine;
        const auto a = derivative(reference);
        const auto b = derivative(moved(a, h / 2));
        const auto c = derivative(moved(b, h / 2));
        const auto d = derivative(moved(c, h));
        reference.x += h / 6 * (a.x + 2 * b.x + 2 * c.x + d.x);
        reference.v += h / 6 * (a.v + 2 * b.v + 2 * c.v + d.v);
    }
    const auto error = [&](int steps) {
        auto state = start;
        const auto stepper = battery.exact ? battery.exact(scene) : battery.make(scene);
        REQUIRE(stepper->step(state, duration / steps, steps));
        return std::max(gap(state.x, reference.x), gap(state.v, reference.v));
    };
    return std::log2(error(800) / error(1600));
}

}  // namespace

double gap(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a.size() == 0 ? 0 : (a - b).cwiseAbs().maxCoeff();
}

Scene smooth_scene(const Kind& kind) {
    Random random(77);
    Scene scene(kind);
    for (int i = 0; i < 6; ++i) {
        Eigen::VectorXd place = random_vector(random, kind.dim, -0.25, 0.25);
        place[0] += i;
        scene.add_particle(place, random.uniform(0.5, 2));
    }
    for (int i = 0; i < 6; ++i) {
        for (int j = i + 1; j < 6 && j < i + 3; ++j)
            scene.add_spring(spring_between(scene, i, j, random.uniform(5, 20), 0.4 * (j - i)));
    }
    scene.pin(0);
    scene.pin(5);
    scene.set_gravity(random_vector(random, kind.dim, -3, 3));
    return scene;
}

Scene linear_scene(const Kind& kind, bool damped) {
    Random random(78);
    Scene scene(kind);
    for (int i = 0; i < 7; ++i)
        scene.add_particle(random_vector(random, kind.dim, -1, 1), random.uniform(0.5, 2));
    for (int i = 0; i < 12; ++i) {
        const int b = (2 * i + 1) % 7;
        scene.add_spring(
            spring_between(scene, i % 7, b == i % 7 ? (i + 1) % 7 : b, random.uniform(5, 50)));
    }
    scene.pin(3);
    scene.set_gravity(random_vector(random, kind.dim, -3, 3));
    if (damped) scene.set_rayleigh(0.25, 0.0078125);
    return scene;
}

void test_stepper(const StepperBattery& battery) {
    const auto each = [&](const char* promise, void (*check)(const StepperBattery&, const Kind&)) {
        SECTION(promise) {
            for (const Kind& kind : battery.kinds) {
                INFO(kind.text());
                check(battery, kind);
            }
        }
    };
    each("count steps are count single steps, to the bit", check_counted_steps);
    each("a bad step or state is reported and nothing is touched", check_bad_input);
    each("pinned particles obey their velocity", check_pins);
    each("linear momentum of an unpinned scene is kept to rounding", check_momentum);
    each("changes of the system and the state between steps are taken up", check_takes_up);
    each("a scene without free particles is stepped without failure", check_nothing_free);
    each("nothing is computed that a floating-point trap would stop", check_faults);
    if (battery.linear) each("a linear scene moves as its matrices do", check_linear_scene);
    if (battery.diverges) each("divergence is reported and the state put back", check_divergence);
    if (battery.order > 0) {
        SECTION("the measured order of convergence is the declared one") {
            CHECK_THAT(measured_order(battery), WithinAbs(battery.order, 0.05));
        }
    }
}

}  // namespace taut_test
