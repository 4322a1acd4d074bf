// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What stiffness position-based steps give a chain and a cloth, beside springs of so many N/m.
// docs/coming_from.md reads along. Fails where a correspondence that the page states does not hold.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/newton/newton.hpp>
#include <taut/taut.hpp>
#include <utility>

#include "common/number.hpp"

namespace {

using Net = taut::SpringSystem<double, 3>;
using taut::Index;

bool all_true = true;

void expect(bool claim, const char* what) {
    if (claim) return;
    std::printf("NOT TRUE: %s\n", what);
    all_true = false;
}

/// XPBD (Macklin, Müller, Chentanez 2016) over the springs of a net, with compliance 1/k of each.
/// PBD is its limit: compliance 0, and a share of each correction in its place.
struct PositionBased {
    double share = 1;  // of a correction that is made: PBD's stiffness
    bool compliant = true;
    int iterations = 10;
    double drag = 0;  // 1/s, to come to rest

    void step(const Net& net, Net::State& state, double h) const {
        const auto& set = net.springs();
        const auto w = net.inverse_mass();
        taut::Points<double, 3> x = state.x;
        for (Index i = 0; i < net.size(); ++i) {
            if (w[i] > 0) x.col(i) += h * (state.v.col(i) / (1 + drag * h) + h * net.gravity());
        }
        Eigen::VectorXd lambda = Eigen::VectorXd::Zero(net.spring_count());
        for (int repeat = 0; repeat < iterations; ++repeat) {
            for (Index s = 0; s < net.spring_count(); ++s) {
                const auto [a, b] = std::pair(set.a[s], set.b[s]);
                const double alpha = compliant ? 1 / (set.parameters[s].stiffness * h * h) : 0;
                const Eigen::Vector3d d = x.col(b) - x.col(a);
                const double C = d.norm() - set.rest_length[s];
                const double W = w[a] + w[b];
                if (W == 0) continue;
                const double change = -share * (C + alpha * lambda[s]) / (W + alpha);
                lambda[s] += change;
                x.col(a) -= w[a] * change * d.normalized();
                x.col(b) += w[b] * change * d.normalized();
            }
        }
        state.v = (x - state.x) / h;
        state.x = x;
    }
};

/// Particles of mass kg hung one below the other, the first pinned.
Net chain(int links, double mass, double k) {
    Net net;
    for (int i = 0; i <= links; ++i) net.add_particle({0, 0, -0.1 * i}, mass);
    for (int i = 0; i < links; ++i) net.add_spring(i, i + 1, k);
    net.pin(0);
    net.set_gravity({0, 0, -9.81});
    return net;
}

/// How much longer than laid out the chain hangs at rest, m.
double sag(const Net& net, const PositionBased& solver, double h) {
    auto state = net.initial_state();
    while (state.time * solver.drag < 24) {
        solver.step(net, state, h);
        state.time += h;
    }
    return net.initial_state().x(2, net.size() - 1) - state.x(2, net.size() - 1);
}

double sag(const Net& net) {
    auto state = net.initial_state();
    if (!taut::static_equilibrium(net, state)) return NAN;
    return net.initial_state().x(2, net.size() - 1) - state.x(2, net.size() - 1);
}

constexpr double frame = 1.0 / 60;  // s

// Dragged so that they come to rest soon.
PositionBased xpbd(int iterations) { return {1, true, iterations, 20}; }
PositionBased pbd(double share, int iterations, double drag) {
    return {share, false, iterations, drag};
}

/// The stiffness that `iterations` passes with PBD's stiffness `share` give one link, N/m.
double stiffness_of(double share, int iterations, double h, double W) {
    return (std::pow(1 - share, -iterations) - 1) / (h * h * W);
}

void compliance() {
    const Net net = chain(10, 0.01, 1000);
    const double spring = sag(net);
    std::printf("10 links of 1000 N/m, 10 g each: %.3f mm of sag\n", 1e3 * spring);
    for (const int iterations : {300, 50, 10, 1}) {
        const double ratio = sag(net, xpbd(iterations), frame) / spring;
        std::printf("  XPBD, compliance 1e-3 m/N, %d iterations a frame: %.2f times that\n",
                    iterations, ratio);
        expect(iterations < 300 || std::abs(ratio - 1) < 1e-3, "converged XPBD is the spring");
    }
    for (const int substeps : {10, 40}) {
        const double ratio = sag(net, xpbd(1), frame / substeps) / spring;
        std::printf("  %d substeps of one iteration: %.2f times\n", substeps, ratio);
        expect(substeps < 40 || ratio < 1.5, "substeps converge as well");
    }
}

/// Of ten steps of XPBD, converged, and of implicit Euler, relative to the way gone.
double apart(const Eigen::Vector3d& gravity) {
    Net net = chain(10, 0.01, 1000);
    net.set_gravity(gravity);
    auto ours = net.initial_state();
    auto theirs = ours;
    taut::NewtonEuler<Net>::Options options;
    options.tolerance = 1e-10;
    taut::NewtonEuler stepper(net, options);
    for (int i = 0; i < 10; ++i) {
        expect(bool(stepper.step(ours, frame)), "Newton converges");
        PositionBased{1, true, 1000, 0}.step(net, theirs, frame);
    }
    return (ours.x - theirs.x).norm() / (ours.x - net.initial_state().x).norm();
}

void same_step() {
    const double bounces = apart({0, 0, -9.81});
    const double swings = apart({9.81, 0, 0});
    std::printf(
        "ten steps of XPBD, converged, and of implicit Euler: %.0e apart where the chain "
        "bounces, %.1f %% where it swings\n",
        bounces, 100 * swings);
    expect(bounces < 1e-6 && swings < 0.02, "converged XPBD is close to implicit Euler");
}

void stiffness() {
    for (const double share : {0.1, 0.5}) {
        for (const int iterations : {1, 10}) {
            for (const double h : {frame, frame / 4}) {
                Net net = chain(1, 0.01, 1);
                const double k = stiffness_of(share, iterations, h, 1 / 0.01);
                net.set_stiffness(0, k);
                const double ratio = sag(net, pbd(share, iterations, 20), h) / sag(net);
                std::printf("  PBD stiffness %.1f, %d iterations of 1/%.0f s: %.3g N/m; sag %.4f\n",
                            share, iterations, 1 / h, k, ratio);
                expect(std::abs(ratio - 1) < 1e-3, "one link of PBD is the spring of the formula");
            }
        }
    }
}

/// The same of a chain that is long beside the number of iterations, swept from its pinned end.
double stiffness_of_long(double share, int iterations, double h, double mass) {
    return iterations * mass * share / ((2 - share) * h * h);
}

void long_chains() {
    struct Case {
        double share;
        int iterations;
        double h;
    };
    for (const auto& [share, iterations, h] :
         {Case{0.5, 10, frame}, {1, 1, frame}, {1, 10, frame}, {1, 1, frame / 4}}) {
        Net net = chain(80, 0.01, 1);
        const double k = stiffness_of_long(share, iterations, h, 0.01);
        for (Index s = 0; s < net.spring_count(); ++s) net.set_stiffness(s, k);
        const double ratio = sag(net, pbd(share, iterations, 2), h) / sag(net);
        std::printf("  PBD stiffness %.1f, %d iterations of 1/%.0f s: %.3g N/m; sag %.2f\n", share,
                    iterations, 1 / h, k, ratio);
        expect(std::abs(ratio - 1) < 0.1, "a long chain of PBD has its own formula");
    }
}

/// What MuJoCo's constraints are, with an impedance d that does not depend on the violation, N/m.
/// @param inverse_mass  of the constraint, 1/kg: of a tendon 1/m1 + 1/m2, of a flex edge half of
/// that
double stiffness_of_mujoco(double timeconst, double dampratio, double d, double inverse_mass) {
    return 1 / ((1 - d) * timeconst * timeconst * dampratio * dampratio * inverse_mass);
}

void mujoco() {
    const double mass = taut::hanging_cloth<double>({64, 64}).mass(100);
    const double usual = stiffness_of_mujoco(0.02, 1, 0.95, 1 / mass);
    std::printf(
        "MuJoCo's solref 0.02 1, impedance 0.95: %.0f N/m on 1 kg, %.2f N/m on this cloth\n",
        stiffness_of_mujoco(0.02, 1, 0.95, 1), usual);
    std::printf("  1000 N/m on this cloth: timeconst %.2e s\n", 0.02 * std::sqrt(usual / 1000));
}

double largest_stretch(const Net& net, const Net::State& state) {
    double stretch = 0;
    const auto& set = net.springs();
    for (Index s = 0; s < net.spring_count(); ++s) {
        const double l = (state.x.col(set.b[s]) - state.x.col(set.a[s])).norm();
        stretch = std::max(stretch, l / set.rest_length[s]);
    }
    return stretch;
}

void hanging() {
    const Net net = taut::hanging_cloth<double>({12, 12});
    auto rest = net.initial_state();
    expect(bool(taut::static_equilibrium(net, rest)), "the cloth comes to rest");
    const double spring = largest_stretch(net, rest);
    std::printf("12 x 12 cloth of 1000 N/m, at rest: l/L up to %.3f\n", spring);
    const auto hang = [&](int iterations, int substeps) {
        auto state = rest;
        const PositionBased solver{1, true, iterations, 20};
        for (int i = 0; i < 60 * substeps; ++i) solver.step(net, state, frame / substeps);
        const double stretch = largest_stretch(net, state);
        std::printf("  XPBD, a second later, %d substeps of %d iterations: %.3f\n", substeps,
                    iterations, stretch);
        return stretch;
    };
    expect(hang(10, 1) - 1 > 5 * (spring - 1), "ten iterations a frame are rubber");
    expect(hang(1, 12) - 1 < 3 * (spring - 1), "substeps of one iteration are not");
}

void cloth() {
    const Net net = taut::hanging_cloth<double>({64, 64});
    const double W = 2 / net.mass(100);
    const double k = 1000;
    const double moving = taut::any_pose_limit(net).certified;
    std::printf("64 x 64 cloth, 0.3 kg, 1000 N/m: compliance 1e-3 m/N\n");
    const double h = taut::energy_limit(net).certified;
    std::printf("  h^2 k W: %.0f at 1/60 s, %.2f at the any-pose limit of %s s\n",
                frame * frame * k * W, moving * moving * k * W,
                example::rounded_down(moving, 3, 'g').c_str());
    std::printf("  %.2f at %s s, at which energy never rises (%d a frame)\n", h * h * k * W,
                example::rounded_down(h, 3, 'g').c_str(), int(std::ceil(frame / h)));
    std::printf("  10 iterations at 1/60 s: PBD stiffness %.3f for one link; for a row %.2f N/m\n",
                1 - std::pow(1 + frame * frame * k * W, -1.0 / 10),
                stiffness_of_long(1, 10, frame, net.mass(100)));
    const double iterations = k * frame * frame / net.mass(100);
    std::printf("  a row of 1000 N/m asks for %.0f iterations a frame, or %.0f substeps of one\n",
                iterations, std::sqrt(iterations));
}

/// A square sheet of springs k along edges and diagonals, by the energy of a stretch of 1e-4 with
/// the lateral contraction that asks least of it. @returns Young's modulus times thickness, N/m
double sheet() {
    taut::ClothOptions options{48, 48};
    options.bend = 0;
    const Net net = taut::hanging_cloth<double>(options);
    double least = INFINITY;
    for (double nu = 0.4; nu < 0.6; nu += 0.01) {
        auto state = net.initial_state();
        state.x.row(0) *= 1 + 1e-4;
        state.x.row(1) *= 1 - nu * 1e-4;
        least = std::min(least, 2 * net.potential_energy(state) / 1e-8);
    }
    return least;
}

}  // namespace

int main() {
    compliance();
    same_step();
    std::printf("One link, 10 g; sag beside that of the spring:\n");
    stiffness();
    std::printf("A chain of 80 of them:\n");
    long_chains();
    cloth();
    hanging();
    mujoco();
    const double ratio = sheet() / 1000;
    std::printf("Young's modulus times thickness of a sheet of k: %.2f k\n", ratio);
    expect(std::abs(ratio - 1.5) < 0.05, "1.5 k");
    return all_true ? 0 : 1;
}
