// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Choi and Ko's cloth: springs that only pull, bending springs that push as a buckled beam, and
// BDF2. docs/systems/stable_but_responsive.md reads along.

#include <cmath>
#include <cstdio>
#include <taut/bdf2/bdf2.hpp>
#include <taut/taut.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

using taut::Buckling;
using taut::TensionOnly;

int main() {
    const double k = 1000;        // N/m
    const double bending = 1e-4;  // N m^2
    taut::SpringSystem<double, 3, TensionOnly, Buckling> strip;
    for (int i = 0; i < 21; ++i) strip.add_particle({0.05 * i, 0, 1e-4 * std::sin(i)}, 0.01);
    for (int i = 0; i < 20; ++i) strip.add_spring<TensionOnly>(i, i + 1, {k});
    for (int i = 0; i < 19; ++i) strip.add_spring<Buckling>(i, i + 2, {k, bending, k});
    strip.pin(0);
    strip.pin(20);

    auto state = strip.initial_state();
    taut::Bdf2 stepper(strip);
    for (int frame = 0; frame < 60; ++frame) {
        state.v(0, 20) = -0.3;  // the end moves in, m/s
        if (!stepper.step(state, 1.0 / 60)) return 1;
    }
    std::printf("pushed in by %.2f m, the strip rises by %.2f m\n", 1 - state.x(0, 20),
                state.x.row(2).cwiseAbs().maxCoeff());
}
