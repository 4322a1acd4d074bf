// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The nonlinear guarantee: springs that only pull, an implicit step that is solved, and energy that
// never rises, at any step. docs/systems/energy.md reads along.

#include <cstdio>
#include <taut/newton/energy_guarantee.hpp>
#include <taut/projective/projective.hpp>
#include <taut/taut.hpp>
#include <taut/network/tension_only.hpp>

int main() {
    using Net = taut::SpringSystem<double, 3, taut::TensionOnly>;
    static_assert(taut::energy_never_rises_v<Net>);
    static_assert(!taut::energy_never_rises_v<taut::SpringSystem<double, 3>>);

    Net net;
    const auto cloth = taut::hanging_cloth<double>({8, 8});
    for (taut::Index i = 0; i < cloth.size(); ++i) {
        net.add_particle(cloth.initial_state().x.col(i), cloth.mass(i));
    }
    cloth.for_each_spring(
        [&](taut::Index a, taut::Index b) { net.add_spring<taut::TensionOnly>(a, b, {1000}); });
    net.pin(0);
    net.pin(7);
    net.set_gravity({0, 0, -9.81});

    taut::ProjectiveDynamics<Net>::Options options;
    options.iterations = 20000;  // solve the step, whatever it takes
    options.tolerance = 1e-8;
    taut::ProjectiveDynamics stepper(net, options);
    auto state = net.initial_state();
    double energy = net.energy(state);
    for (const double h : {1e-3, 1e-1, 1e1}) {
        for (int i = 0; i < 5; ++i) {
            const auto report = stepper.step(state, h);
            if (!report || report.residual > options.tolerance) return 1;
            if (net.energy(state) > energy + 1e-3) return 1;
            energy = net.energy(state);
        }
        std::printf("after five steps of %g s: %.4f J\n", h, energy);
    }
}
