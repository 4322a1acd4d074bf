// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Each way to blow up that docs/explode.md names, and the call that tells it from the others. Fails
// if one of them does not happen.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <taut/contact/contact.hpp>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>
#include <taut/accuracy/accuracy.hpp>
#include <taut/tight/tight.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/with_law.hpp>

#include "common/number.hpp"

namespace {

using Net = taut::SpringSystem<double, 3>;
using example::rounded_down;
using example::rounded_up;
using taut::Index;
using taut::Method;

bool all_true = true;

void expect(bool claim, const char* what) {
    if (claim) return;
    std::printf("NOT TRUE: %s\n", what);
    all_true = false;
}

Net cloth() { return taut::hanging_cloth<double>({12, 12}); }

double largest_stretch(const Net& net, const Net::State& state) {
    double stretch = 0;
    const auto& set = net.springs();
    for (Index s = 0; s < net.spring_count(); ++s) {
        const double l = (state.x.col(set.b[s]) - state.x.col(set.a[s])).norm();
        stretch = std::max(stretch, l / set.rest_length[s]);
    }
    return stretch;
}

void not_finite_at_once() {
    const Net net = cloth();
    auto state = net.initial_state();
    const taut::Stability<double> stability(net, state);
    const double h = 1.0 / 60;
    const double factor = taut::spectral_radius(stability, Method::symplectic_euler, h);
    state.v(2, 70) = 1e-3;
    taut::SymplecticEuler stepper(net);
    int frames = 0;
    while (frames < 1000 && stepper.step(state, h)) ++frames;
    std::printf("1/60 s: a vibration grows %.0f-fold a step; not finite after %d frames\n", factor,
                frames);
    std::printf("safe: %d substeps, or all stiffness times %s, or all masses times %s\n",
                int(stability.max_step(Method::symplectic_euler).substeps(h).value_or(0)),
                rounded_down(stability.max_stiffness_scale(Method::symplectic_euler, h), 2).c_str(),
                rounded_up(stability.min_mass_scale(Method::symplectic_euler, h), 3, 'g').c_str());
    expect(frames < 100, "NaN within 100 frames");
}

void saw_tooth() {
    const Net net = cloth();
    auto still = net.initial_state();
    expect(bool(taut::static_equilibrium(net, still)), "the cloth comes to rest");
    const taut::Stability<double> stability(net, still);
    const auto limit = taut::max_step(stability, Method::symplectic_euler, 1e-3);
    for (const double h : {0.99 * limit.certified, 1.01 * limit.refuted}) {
        auto state = still;
        state.v(0, 70) = 1e-9;
        taut::SymplecticEuler stepper(net);
        int steps = 0, turns = 0;
        for (; steps < 1000 && state.v.norm() < 1e-3; ++steps) {
            const Eigen::Vector3d before = state.v.col(70);
            if (!stepper.step(state, h)) break;
            if (steps >= 20 && before.dot(state.v.col(70)) < 0) ++turns;
        }
        std::printf("%.3e s: speed %.0e m/s after %d steps, turned round in %d of the last %d\n", h,
                    state.v.norm(), steps, turns, steps - 20);
        expect(h < limit.certified ? state.v.norm() < 1e-8 : turns > (steps - 20) * 9 / 10,
               "above the limit, and only there, velocities grow and change sign each step");
    }
}

void grows_in_swings() {
    Net net;  // a bob on a soft spring: one swing a second
    net.pin(net.add_particle({0, 0, 0}, 1));
    net.add_spring(0, net.add_particle({0, 0, -1}, 1), 40);
    for (const double h : {0.02, 0.002}) {
        const taut::Stability<double> stability(net, net.initial_state());
        const auto growth = [&](Method method) {  // in a second
            return std::pow(taut::spectral_radius(stability, method, h), 1 / h);
        };
        std::printf("%.3f s: x%.2f a second by explicit, x%.2f by symplectic Euler\n", h,
                    growth(Method::explicit_euler), growth(Method::symplectic_euler));
        auto state = net.initial_state();
        state.x(2, 1) -= 0.01;
        taut::ExplicitEuler stepper(net);
        double largest = 0;
        while (state.time < 10) {
            if (!stepper.step(state, h)) break;
            if (state.time > 9) largest = std::max(largest, -1 - state.x(2, 1));
        }
        const double predicted = 0.01 * std::pow(growth(Method::explicit_euler), 10);
        expect(largest > 0.7 * predicted && largest < 1.1 * predicted, "it grows as predicted");
    }
}

void only_when_it_moves() {
    Net net;  // a ball amid eight cords
    const Index ball = net.add_particle({0, 0, 0}, 1);
    for (int i = 0; i < 8; ++i) {
        const Index end = net.add_particle({std::cos(i * 0.7854), std::sin(i * 0.7854), 0}, 1);
        net.add_spring(ball, end, 20);
        net.pin(end);
    }
    net.set_gravity({0, 0, -9.81});
    const taut::Stability<double> stability(net, net.initial_state());
    const double at_start = 0.95 * stability.max_step(Method::symplectic_euler).certified;
    const double proved = taut::energy_limit(net).certified;
    taut::SymplecticEuler symplectic(net);
    taut::EnergyStableEuler stable(net);
    const auto farthest = [&](auto& stepper, double h) {
        auto state = net.initial_state();
        double far = 0;
        while (state.time < 10 && far < 1e6 && stepper.step(state, h)) {
            far = std::max(far, state.x.col(ball).norm());
        }
        return far;
    };
    const double exploded = farthest(symplectic, at_start), held = farthest(stable, proved);
    std::printf("ball on cords, %.3f s, 0.95 of the limit where it starts: it goes %.1e m far\n",
                at_start, exploded);
    std::printf("ball on cords, %s s, EnergyStableEuler at its limit: it goes %.1e m far\n",
                rounded_down(proved, 2, 'g').c_str(), held);
    expect(exploded > 1e5 && held < 2, "only the step that is proved at every pose holds");
}

/// A cloth in free fall on a floor that pushes back with k N/m a particle. @returns its largest
/// speed
template <class Advance>
double fall(Net& net, double k, Advance advance) {
    net.set_external_force([k](const auto& state, auto& force) {
        force.row(2) += k * (-0.05 - state.x.row(2).array()).max(0).matrix();
    });
    auto state = net.initial_state();
    double speed = 0;
    while (state.time < 0.5 && speed < 1e6) {
        if (!advance(state)) return 1e6;
        speed = std::max(speed, state.v.colwise().norm().maxCoeff());
    }
    return speed;
}

void only_when_it_collides() {
    taut::ClothOptions options{12, 12};
    options.pin_corners = false;
    const double k = 8e5;  // N/m
    Net net = taut::hanging_cloth<double>(options);
    const double h = taut::energy_limit(net).certified;

    taut::EnergyStableEuler stepper(net);
    const double bare = fall(net, k, [&](auto& state) { return bool(stepper.step(state, h)); });

    int frames = 0, again = 0;
    taut::Guarded guard(net);
    const double guarded = fall(net, k, [&](auto& state) {
        const auto report = guard.advance(state, 1.0 / 60);
        ++frames;
        again += report.again > 0;
        return bool(report);
    });

    Net counted = taut::hanging_cloth<double>(options);
    for (Index i = 0; i < net.size(); ++i) {  // the floor's stiffness, for the analysis alone
        const Index floor = counted.add_particle(net.initial_state().x.col(i), 1);
        counted.add_spring(i, floor, k);
        counted.pin(floor);
    }
    const double shorter = taut::energy_limit(counted).certified;
    const double small =
        fall(net, k, [&](auto& state) { return bool(stepper.step(state, shorter)); });

    taut::Contacts contacts(net);
    contacts.add(taut::HalfSpace<double, 3>({0, 0, -0.05}, {0, 0, 1}));
    const double inside = fall(net, 0, [&](auto& state) {
        return bool(taut::step_through(stepper, state, h, 1, contacts));
    });
    std::printf("floor of %.0e N/m, %s s: %.1f m/s\n", k, rounded_down(h, 3).c_str(), bare);
    std::printf("guarded: %.1f m/s, %d of %d frames taken again\n", guarded, again, frames);
    std::printf("counted in, %s s: %.1f m/s; Contacts, %s s: %.1f m/s\n",
                rounded_down(shorter, 3).c_str(), small, rounded_down(h, 3).c_str(), inside);
    expect(bare > 15 && small < 2 && inside < 2,
           "what the analysis does not see blows up; counted in or inside the step it does not");
    expect(guarded < 2 && again > 0, "the guard follows the floor in shorter steps");
}

void only_when_dragged() {
    const Net net = cloth();
    const double limit = taut::any_pose_limit(net).certified;
    const double h = taut::energy_limit(net).certified;
    for (const bool jump : {true, false}) {
        auto state = net.initial_state();
        taut::EnergyStableEuler stepper(net);
        if (jump) state.x(2, 0) += 0.3;
        double speed = 0;
        while (state.time < 0.3) {
            state.v(2, 0) = jump || state.time > 0.2 ? 0 : 1.5;
            if (!stepper.step(state, h)) break;
            speed = std::max(speed, state.v.colwise().norm().maxCoeff());
        }
        std::printf("pin %s by 0.3 m: up to %.1f m/s\n", jump ? "set away" : "moved at 1.5 m/s",
                    speed);
        expect((speed > 30) == jump, "a jump of a pin is a blow");
    }
    for (const double k : {1e5, 1e3}) {
        Net dragged = cloth();
        const Index hand = dragged.add_particle(dragged.initial_state().x.col(70), 1);
        dragged.pin(hand);
        dragged.add_spring(70, hand, k);
        const double less = taut::any_pose_limit(dragged).certified;
        std::printf("mouse spring of %.0e N/m: the any-pose limit goes from %s s to %s s\n", k,
                    rounded_down(limit, 3).c_str(), rounded_down(less, 3).c_str());
        expect((less < 0.9 * limit) == (k > 1e4),
               "a stiff mouse spring takes step, a soft one does not");
    }
}

void only_after_a_change() {
    Net net = cloth();
    const auto before = taut::any_pose_limit(net);
    net.set_mass(70, net.mass(70) / 8);
    const bool stale = !before.step_for(net, 0.95);
    const double light = taut::any_pose_limit(net).certified;
    net = cloth();
    net.remove_springs([](Index s) { return s % 3 == 0; });
    const double torn = taut::any_pose_limit(net).certified;
    std::printf("old limit %s; one mass / 8: %s s, a third of the springs torn: %s s\n",
                stale ? "refused" : "taken", rounded_down(light, 3).c_str(),
                rounded_down(torn, 3).c_str());
    expect(stale && light < 0.6 * before.certified && torn >= before.certified,
           "light particles take step, torn springs do not");
}

void only_in_float() {
    auto net = taut::hanging_cloth<float>({12, 12});
    const float weight = net.mass(70) * 9.81f;
    net.set_gravity({0, 0, 0});
    for (const float away : {0.0f, 1000.0f}) {
        auto state = net.initial_state();
        state.x.array() += away;
        taut::Points<float, 3> force;
        net.force(state, force);
        const float noise = force.colwise().norm().maxCoeff() / weight;
        std::printf("float, %.0f m from the origin: forces of %.2g weights out of rounding\n",
                    double(away), double(noise));
        expect((noise > 1) == (away > 0), "far from the origin rounding is a force");
    }
}

void sags() {
    for (const double k : {1000.0, 20.0}) {
        taut::ClothOptions options{12, 12};
        options.stretch = k;
        const Net net = taut::hanging_cloth<double>(options);
        auto state = net.initial_state();
        expect(bool(taut::static_equilibrium(net, state)), "it comes to rest");
        std::printf("%.0f N/m: hangs with l/L up to %.2f, any-pose limit %s s\n", k,
                    largest_stretch(net, state),
                    rounded_down(taut::any_pose_limit(net).certified, 3).c_str());
    }
}

void goes_dead() {
    const double omega = 6.2832;  // 1 Hz
    std::printf("1 Hz at 1/60 s: implicit Euler damps by %.3f of critical, BDF2 by %.4f\n",
                taut::artificial_damping(Method::implicit_euler, omega / 60),
                taut::artificial_damping(Method::bdf2, omega / 60));
    std::printf("alpha of 0.01 s: %.2f of critical at 1 Hz, %.2f at 10 Hz\n",
                taut::damping_ratio({0, 0.01}, omega), taut::damping_ratio({0, 0.01}, 10 * omega));
}

void crumples() {
    Net net;  // a row of springs, pushed together by 5 %
    for (int i = 0; i <= 10; ++i) net.add_particle({0.1 * i, 0, 0}, 0.01);
    for (int i = 0; i < 10; ++i) net.add_spring(i, i + 1, 100);
    net.pin(0);
    net.pin(10);
    auto state = net.initial_state();
    state.x.row(0) *= 0.95;
    const taut::Stability<double> stability(net, state);
    const auto limit = taut::max_step(stability, Method::symplectic_euler, 1e-3);
    state.x(2, 5) = 1e-6;
    const double start = net.energy(state);
    double highest = 0, rise = 0;
    taut::SymplecticEuler stepper(net);
    while (state.time < 3) {
        if (!stepper.step(state, 0.01 * limit.certified)) break;
        highest = std::max(highest, state.x.row(2).cwiseAbs().maxCoeff());
        rise = std::max(rise, net.energy(state) / start - 1);
    }
    std::printf(
        "%s: grows by e^(%.0f t) at every step; at most %.2f m aside, energy up by %.1f %%\n",
        name(limit.cause), limit.growth_rate, highest, 100 * rise);
    expect(limit.growth_rate > 10 && highest > 0.05 && rise < 0.02, "it buckles, and no more");
}

using Threads = taut::SpringSystem<double, 3, taut::TensionOnly>;

/// The most that the energy of ten seconds rises above its start, and in one step or frame, J.
struct Rise {
    double above = 0, step = 0;
};

template <class Advance>
Rise energy_rise(const Threads& net, Advance advance) {
    auto state = net.initial_state();
    const double start = net.energy(state);
    double before = start;
    Rise rise;
    while (state.time < 10 && rise.above < 1e6 && advance(state)) {
        const double energy = net.energy(state);
        rise.above = std::max(rise.above, energy - start);
        rise.step = std::max(rise.step, energy - before);
        before = energy;
    }
    return rise;
}

void only_if_it_cannot_push() {
    const Threads net = taut::with_law<taut::TensionOnly>(cloth());
    const double linear = 0.95 * taut::any_pose_limit(net).certified;
    taut::SymplecticEuler symplectic(net);
    const Rise bare =
        energy_rise(net, [&](auto& state) { return bool(symplectic.step(state, linear)); });
    const double h = taut::energy_limit(net).certified;
    taut::EnergyStableEuler stepper(net);
    const Rise proved = energy_rise(net, [&](auto& state) { return bool(stepper.step(state, h)); });
    taut::Guarded guard(net);
    int trimmed = 0, again = 0;
    const Rise guarded = energy_rise(net, [&](auto& state) {
        const auto report = guard.advance(state, 1.0 / 60);
        trimmed += report.taken == taut::Taken::trimmed;
        again += report.taken == taut::Taken::again;
        return bool(report);
    });
    std::printf("threads, symplectic Euler, %.2e s: up to %.2f J above the start\n", linear,
                bare.above);
    std::printf("EnergyStableEuler, %s s: up to %.2f J above the start, %.0e J in one step\n",
                rounded_down(h, 3).c_str(), proved.above, proved.step);
    std::printf("the guard: up to %.2f J above the start, %d of 600 frames trimmed, %d again\n",
                guarded.above, trimmed, again);
    expect(bare.above > 0.1, "a limit of the linearisation does not bound the energy of threads");
    expect(proved.above < 1e-12 && proved.step < 1e-12, "no proved step raises the energy");
    expect(guarded.above < 1e-8, "nor does the guard, but for rounding");
}

void only_at_rest_length() {
    Threads row;  // at its rest length, between two pins
    for (int i = 0; i < 4; ++i) row.add_particle({0.1 * i, 0, 0}, 0.01);
    for (int i = 0; i < 3; ++i) row.add_spring<taut::TensionOnly>(i, i + 1, {1000});
    row.pin(0);
    row.pin(3);
    const auto faster = [&](auto stepper, double h) {  // in 5000 steps, at most 1e7 times
        auto state = row.initial_state();
        double most = state.v(0, 1) = 1e-9;
        for (int i = 0; i < 5000 && most < 0.01 && stepper.step(state, h); ++i)
            most = std::max(most, state.v.cwiseAbs().maxCoeff());
        return std::min(1e9 * most, 1e7);
    };
    const double linear =
        0.99 * taut::any_pose_limit(row).certified;  // of a row: of this pose, too
    const double bare = faster(taut::SymplecticEuler(row), linear);
    const double stable = faster(taut::EnergyStableEuler(row), taut::energy_limit(row).certified);
    std::printf("threads at rest length, 0.99 of the any-pose limit: %.0e times as fast\n", bare);
    std::printf("EnergyStableEuler at its limit: %.2f times as fast\n", stable);
    expect(bare >= 1e7 && stable < 1 + 1e-9, "what switches is not linear, and T42 holds for it");
}

}  // namespace

int main() {
    not_finite_at_once();
    saw_tooth();
    grows_in_swings();
    only_when_it_moves();
    only_when_it_collides();
    only_when_dragged();
    only_after_a_change();
    only_in_float();
    sags();
    goes_dead();
    crumples();
    only_if_it_cannot_push();
    only_at_rest_length();
    return all_true ? 0 : 1;
}
