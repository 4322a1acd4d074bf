// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The systems that the paper measures itself against: what each costs beside a plain step in the
// same run, and what it keeps. Prints Markdown; times are the minimum and the median of several
// runs, in ms.

#include <cmath>
#include <cstdio>
#include <taut/bdf2/bdf2.hpp>
#include <taut/modal/modal_dynamics.hpp>
#include <taut/model/buckling.hpp>
#include <taut/model/tension_only.hpp>
#include <taut/modal/modal_analysis.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "hanging_net.hpp"
#include "measure.hpp"

namespace {

using bench::Stopwatch;
using bench::Times;
using taut::Index;
using Cloth = taut::SpringSystem<double, 3>;

constexpr double frame = 1.0 / 60;  // s

void require(bool ok) {
    if (!ok) std::printf("A STEP FAILED\n");
}

template <class Shape>
void modal_row(const char* name, const taut::LinearSystem<double>& linear, const Cloth::State& pose,
               const taut::ModalBasis& basis) {
    taut::ModalDynamics<Shape, 3> modal(linear, pose, basis);
    taut::Points<Shape, 3> x;
    Stopwatch step, positions;
    for (int run = 0; run < 500; ++run) {
        step.run([&] { require(bool(modal.step(frame))); });
        positions.run([&] { modal.positions(x); });
    }
    const Times a = step.times();
    const Times b = positions.times();
    const auto numbers = static_cast<double>(basis.shapes.size());
    std::printf("| modal, r = %ld, %s | %.4f / %.4f | %.4f / %.4f | %.1f |\n",
                static_cast<long>(basis.size()), name, a.least, a.median, b.least, b.median,
                numbers * sizeof(Shape) / (b.least * 1e6));
}

void modal() {
    Cloth::State pose;
    const auto net = bench::hanging_net(100, 50, pose);
    const auto linear = taut::linearize(net, pose);
    taut::ModalBasis basis;
    Stopwatch analysis;
    analysis.run([&] { require(bool(taut::modal_analysis(linear, 50, basis))); });
    std::printf(
        "## Modal dynamics: a net of %ld particles held along one edge, a step of 1/60 s\n\n"
        "Analysis of 50 modes: %.0f ms, %.2f to %.1f Hz, %ld without stiffness.\n\n"
        "| | step, ms | positions, ms | GB/s of shapes |\n|---|---|---|---|\n",
        static_cast<long>(net.size()), analysis.times().least, std::sqrt(basis.k[0]) / 6.2832,
        std::sqrt(basis.k[49]) / 6.2832, static_cast<long>(basis.rigid()));
    modal_row<float>("float shapes", linear, pose, basis);
    modal_row<double>("double shapes", linear, pose, basis);
    taut::ImplicitEuler stepper(linear);
    auto u = linear.initial_state();
    require(bool(stepper.step(u, frame)));
    Stopwatch full;
    for (int run = 0; run < 30; ++run) full.run([&] { require(bool(stepper.step(u, frame))); });
    const Times t = full.times();
    std::printf("| all %ld modes: implicit Euler, factors kept | %.2f / %.2f | in it | |\n\n",
                static_cast<long>(linear.size()), t.least, t.median);
}

/// A chain of eight links, swinging for two seconds: the share of its swing's energy that is left.
template <class Stepper, class System>
double energy_left(const System& chain, double swing) {
    auto state = chain.initial_state();
    const double start = chain.energy(state);
    Stepper stepper(chain);
    require(bool(stepper.step(state, frame, 120)));
    return 1 - (start - chain.energy(state)) / swing;
}

void swings() {
    std::printf(
        "## A swing of eight links, undamped, h = 1/60 s: share of the swing's energy left after 2 "
        "s\n\n"
        "| stiffness, N/m | implicit Euler | BDF2 |\n|---|---|---|\n");
    for (double stiffness = 10; stiffness < 2e6; stiffness *= 10) {
        taut::SpringSystem<double, 2> chain;
        const double angle = 0.5;
        double swing = 0;  // J
        for (int i = 0; i < 9; ++i) {
            const double along = 0.1 * i;
            chain.add_particle({along * std::sin(angle), -along * std::cos(angle)}, 0.01);
            if (i > 0) chain.add_spring(i - 1, i, stiffness);
            swing += 0.01 * 9.81 * along * (1 - std::cos(angle));
        }
        chain.pin(0);
        chain.set_gravity({0, -9.81});
        using System = decltype(chain);
        std::printf("| %.0e | %.2f | %.2f |\n", stiffness,
                    energy_left<taut::ImplicitEuler<System>>(chain, swing),
                    energy_left<taut::Bdf2<System>>(chain, swing));
    }
    std::printf("\n");
}

/// ns a spring of one law, over lengths on both sides of rest.
template <class Law>
void law_row(const char* name, const typename Law::template Parameters<double>& p) {
    std::vector<double> lengths(1000);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        lengths[i] = 0.1 + 1.2 * static_cast<double>((i * 617) % 1000) / 1000;
    }
    Stopwatch tension, slope;
    volatile double sink = 0;
    for (int run = 0; run < 300; ++run) {
        tension.run([&] {
            double sum = 0;
            for (const double l : lengths) sum += Law::tension(p, 1.0, l);
            sink = sum;
        });
        slope.run([&] {
            double sum = 0;
            for (const double l : lengths) sum += Law::tension_slope(p, 1.0, l);
            sink = sum;
        });
    }
    const double to_ns = 1e6 / static_cast<double>(lengths.size());
    std::printf("| %s | %.1f | %.1f |\n", name, tension.times().least * to_ns,
                slope.times().least * to_ns);
}

void laws() {
    std::printf(
        "## Laws: ns an evaluation, lengths from 0.1 to 1.3 of rest\n\n"
        "| law | tension | slope |\n|---|---|---|\n");
    law_row<taut::Hookean>("Hookean", {1000});
    law_row<taut::TensionOnly>("TensionOnly", {1000});
    law_row<taut::Buckling>("Buckling", {1000, 1, 1000});
    std::printf("\n");
}

}  // namespace

int main() {
    modal();
    swings();
    laws();
}
