// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <taut/core/status.hpp>
#include <taut/lattice/chain.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "catch.hpp"
#include "dense.hpp"
#include "random_system.hpp"
#include "tolerance.hpp"

namespace taut_test {

// What every stepper promises; each check_… is called by the tests of every integrator.

/// A loose net of 6 particles, 2 of them pinned, undamped, its springs well stretched: smooth
/// forces.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> smooth_scene() {
    Random random(77);
    taut::SpringSystem<Scalar, Dim> system;
    for (int i = 0; i < 6; ++i) {
        auto place = random.vector<Scalar, Dim>(-0.25, 0.25);
        place[0] += static_cast<Scalar>(i);
        system.add_particle(place, static_cast<Scalar>(random.uniform(0.5, 2)));
    }
    for (int i = 0; i < 6; ++i) {
        for (int j = i + 1; j < 6 && j < i + 3; ++j) {
            system.add_spring(
                taut::Spring<Scalar, taut::Hookean>{i,
                                                    j,
                                                    {static_cast<Scalar>(random.uniform(5, 20))},
                                                    static_cast<Scalar>(0.4 * (j - i))});
        }
    }
    system.pin(0);
    system.pin(5);
    system.set_gravity(random.vector<Scalar, Dim>(-3, 3));
    return system;
}

/// A linear scene: zero rest lengths, with gravity, pins and Rayleigh damping.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> linear_scene(bool damped) {
    Random random(78);
    taut::SpringSystem<Scalar, Dim> system;
    for (int i = 0; i < 7; ++i) {
        const auto place = random.vector<Scalar, Dim>(-1, 1);
        system.add_particle(place, static_cast<Scalar>(random.uniform(0.5, 2)));
    }
    for (int i = 0; i < 12; ++i) {
        system.add_spring(taut::Spring<Scalar, taut::Hookean>{
            i % 7,
            (2 * i + 1) % 7 == i % 7 ? (i + 1) % 7 : (2 * i + 1) % 7,
            {static_cast<Scalar>(random.uniform(5, 50))},
            Scalar(0)});
    }
    system.pin(3);
    system.set_gravity(random.vector<Scalar, Dim>(-3, 3));
    if (damped) system.set_rayleigh({0.25, 0.0078125});
    return system;
}

template <template <class...> class Stepper, class Scalar, int Dim>
void check_counted_steps_are_single_steps() {
    Random random(20);
    RandomOptions options;
    options.rayleigh = true;
    options.dampers = true;
    const auto system = random_system<Scalar, Dim>(random, options);
    const auto start = random_state(random, system);
    const auto h = static_cast<Scalar>(0.001);
    auto at_once = start;
    auto singly = start;
    Stepper one(system);
    Stepper many(system);
    const taut::Report report = many.step(at_once, h, 50);
    REQUIRE(report);
    CHECK(report.iterations == 50);
    CHECK(report.where == -1);
    for (int i = 0; i < 50; ++i) REQUIRE(one.step(singly, h));
    CHECK(same_bits(at_once, singly));
    CHECK_THAT(static_cast<double>(at_once.time),
               Catch::Matchers::WithinRel(0.05, Tolerance<Scalar>::accumulated));
    // The same stepper, used again from the start, gives the same bits again.
    auto again = start;
    REQUIRE(many.step(again, h, 50));
    CHECK(same_bits(again, at_once));
    // No step is a step too.
    REQUIRE(many.step(again, h, 0));
    CHECK(same_bits(again, at_once));
}

template <template <class...> class Stepper, class System>
void check_bad_steps(const System& system, typename System::State start) {
    using Scalar = typename System::Scalar;
    using Limits = std::numeric_limits<Scalar>;
    Stepper stepper(system);
    for (const Scalar h :
         {Scalar(0), Scalar(-0.01), Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
        auto state = start;
        const taut::Report report = stepper.step(state, h, 3);
        CHECK(report.status == taut::Status::invalid_step);
        CHECK(report.iterations == 0);
        CHECK(same_bits(state, start));
    }
    for (const bool of_x : {true, false}) {
        auto state = start;
        REQUIRE(stepper.step(state, Scalar(1e-4)));  // it may remember the state that it left
        (of_x ? state.x : state.v).conservativeResize(Eigen::NoChange, system.size() - 1);
        const auto before = state;
        CHECK(stepper.step(state, Scalar(0.01)).status == taut::Status::invalid_state);
        CHECK(same_bits(state, before));
    }
    for (const Scalar bad : {Limits::quiet_NaN(), Limits::infinity()}) {
        for (const bool of_x : {true, false}) {
            auto state = start;
            (of_x ? state.x : state.v)(0, 2) = bad;
            const taut::Report report = stepper.step(state, Scalar(0.01));
            CHECK(report.status == taut::Status::invalid_state);
            CHECK(report.where == 2);
            (of_x ? state.x : state.v)(0, 2) = (of_x ? start.x : start.v)(0, 2);
            CHECK(same_bits(state, start));
        }
    }
    auto state = start;
    CHECK(stepper.step(state, Scalar(0.001)));  // none of it has broken the stepper
}

template <template <class...> class Stepper, class Scalar>
void check_bad_input() {
    Random random(21);
    const auto springs = random_system<Scalar, 2>(random);
    check_bad_steps<Stepper>(springs, random_state(random, springs));
    const auto linear = springs.linearize(springs.initial_state());
    check_bad_steps<Stepper>(linear, random_state(random, linear));
}

template <template <class...> class Stepper>
void check_divergence_is_reported() {
    const auto system = taut::chain<double, 2>({5, taut::ChainEnds::fixed_fixed, 1, 1e6});
    Random random(22);
    auto state = random_state(random, system);
    state.time = 1.5;
    const auto before = state;
    Stepper stepper(system);
    const taut::Report report = stepper.step(state, 1.0, 100000);
    CHECK(report.status == taut::Status::diverged);
    CHECK(report.iterations > 0);
    CHECK(report.iterations < 100000);
    CHECK(report.where >= 0);
    CHECK(report.where < system.size());
    CHECK(same_bits(state, before));
    CHECK(stepper.step(state, 1e-4));
    CHECK(state.time == 1.5 + 1e-4);
}

/// Pinned particles go on with the velocity that the state gives them, to rounding.
template <template <class...> class Stepper, class Scalar>
void check_pinned_particles_obey_their_velocity() {
    Random random(23);
    RandomOptions options;
    options.dampers = true;
    options.rayleigh = true;
    auto system = random_system<Scalar, 3>(random, options);
    system.set_external_force([](const auto&, auto& f) { f.array() += Scalar(5); });
    auto state = random_state(random, system);
    const auto start = state;
    Stepper stepper(system);
    REQUIRE(stepper.step(state, Scalar(0.001), 40));
    for (Index i = 0; i < 2; ++i) {
        CHECK((state.v.col(i) == start.v.col(i)));
        CHECK(distance(state.x.col(i), start.x.col(i) + Scalar(0.04) * start.v.col(i)) <=
              Tolerance<Scalar>::rounding);
    }
    CHECK(distance(state.x.col(2), start.x.col(2) + Scalar(0.04) * start.v.col(2)) >
          1e-4);  // others do not
}

template <template <class...> class Stepper, class Scalar, int Dim>
void check_linear_momentum_is_kept() {
    Random random(24);
    RandomOptions options;
    options.pinned = 0;
    options.gravity = false;
    options.dampers = true;
    auto system = random_system<Scalar, Dim>(random, options);
    system.set_rayleigh({0, 0.0078125});
    auto state = random_state(random, system);
    Eigen::VectorXd mass(system.size());
    for (Index i = 0; i < system.size(); ++i) mass[i] = static_cast<double>(system.mass(i));
    const auto momentum = [&] { return Eigen::VectorXd(state.v.template cast<double>() * mass); };
    const Eigen::VectorXd before = momentum();
    Stepper stepper(system);
    REQUIRE(stepper.step(state, Scalar(0.001), 400));
    CHECK(distance(momentum(), before) <= Tolerance<Scalar>::accumulated);
}

/// Through a SpringSystem and through its LinearSystem: the same trajectory of a linear scene.
template <template <class...> class Stepper, class Scalar, int Dim>
void check_linear_scene() {
    for (const bool damped : {true, false}) {
        const auto springs = linear_scene<Scalar, Dim>(damped);
        Random random(25);
        auto state = random_state(random, springs);
        state.v.col(3).setZero();  // the pinned one
        state.x.col(3) = springs.initial_state().x.col(3);
        const auto linear = springs.linearize(springs.initial_state());
        auto u = linear.to_free(state);
        Stepper through_springs(springs);
        Stepper through_matrices(linear);
        const auto h = static_cast<Scalar>(0.005);
        REQUIRE(through_springs.step(state, h, 200));
        REQUIRE(through_matrices.step(u, h, 200));
        const auto expected = linear.to_free(state);
        CHECK(distance(u.x, expected.x) <= Tolerance<Scalar>::accumulated);
        CHECK(distance(u.v, expected.v) <= Tolerance<Scalar>::accumulated * 10);
        CHECK(u.time == state.time);
    }
}

/// log2 of the ratio of errors at h and h/2, against a fine reference that the library's steppers
/// have no part in: the classical Runge-Kutta method.
template <template <class...> class Stepper, int Dim>
double measured_order() {
    const auto system = smooth_scene<double, Dim>();
    const auto start = system.initial_state();
    const double duration = 0.5;

    auto reference = start;
    const auto derivative = [&](const auto& w) {
        auto rate = w;
        system.force(w, rate.v);
        for (Index i = 0; i < system.size(); ++i) rate.v.col(i) *= system.inverse_mass()[i];
        rate.x = w.v;
        return rate;
    };
    const auto moved = [&](const auto& rate, double h) {
        auto w = reference;
        w.x += h * rate.x;
        w.v += h * rate.v;
        return w;
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
        Stepper stepper(system);
        REQUIRE(stepper.step(state, duration / steps, steps));
        return std::max(distance(state.x, reference.x), distance(state.v, reference.v));
    };
    return std::log2(error(800) / error(1600));
}

/// A stepper that has made steps takes up changes of the system: the next step is that of a new
/// one.
template <template <class...> class Stepper>
void check_takes_up(
    const std::function<void(taut::SpringSystem<double, 3>&, taut::State<double, 3>&)>& change) {
    Random random(26);
    RandomOptions options;
    options.rayleigh = true;
    auto system = random_system<double, 3>(random, options);
    auto state = random_state(random, system);
    Stepper used(system);
    REQUIRE(used.step(state, 0.001, 5));
    change(system, state);
    auto expected = state;
    REQUIRE(used.step(state, 0.001, 2));
    Stepper fresh(system);
    REQUIRE(fresh.step(expected, 0.001, 2));
    CHECK(same_bits(state, expected));
}

template <template <class...> class Stepper>
void check_takes_up_all_changes() {
    check_takes_up<Stepper>([](auto& system, auto&) { system.add_spring(2, 7, 300); });
    check_takes_up<Stepper>([](auto& system, auto&) { system.add_spring(0, 1, 300); });
    check_takes_up<Stepper>([](auto& system, auto&) { system.unpin(1); });
    check_takes_up<Stepper>([](auto& system, auto&) { system.pin(4); });
    check_takes_up<Stepper>([](auto& system, auto&) { system.set_mass(4, 7); });
    check_takes_up<Stepper>([](auto& system, auto&) { system.set_rayleigh({1, 0}); });
    check_takes_up<Stepper>([](auto& system, auto&) { system.set_gravity({0, 50, 0}); });
    check_takes_up<Stepper>([](auto& system, auto&) {
        system.set_external_force([](const auto&, auto& f) { f.array() += 25.0; });
    });
    check_takes_up<Stepper>([](auto&, auto& state) { state.x(0, 4) += 0.25; });
    check_takes_up<Stepper>([](auto&, auto& state) { state.v(0, 4) += 2; });
    check_takes_up<Stepper>([](auto& system, auto& state) {
        system.add_particle({0, 0, 1}, 1);
        system.add_spring(8, 3, 100);
        const auto before = state;
        state = system.initial_state();
        state.x.leftCols(8) = before.x;
        state.v.leftCols(8) = before.v;
    });
}

/// No particles, or all of them pinned: nothing to solve for, and no failure.
template <template <class...> class Stepper>
void check_nothing_free() {
    taut::SpringSystem<double, 3> system;
    Stepper stepper(system);
    auto state = system.initial_state();
    REQUIRE(stepper.step(state, 0.01, 3));
    CHECK_THAT(state.time, Catch::Matchers::WithinRel(0.03, Tolerance<double>::rounding));

    Random random(27);
    RandomOptions options;
    options.pinned = options.particles;
    const auto pinned = random_system<double, 3>(random, options);
    auto moving = random_state(random, pinned);
    const auto start = moving;
    Stepper drag(pinned);
    REQUIRE(drag.step(moving, 0.01, 3));
    CHECK(distance(moving.x, start.x + 0.03 * start.v) <= Tolerance<double>::rounding);
    CHECK((moving.v == start.v));
}

}  // namespace taut_test
