// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A cloth is thrown at 20 m/s; a second of it, and what became of its energy.

#include <cstdio>
#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>

int main() {
    auto cloth = taut::hanging_cloth<float>({64, 64});  // rows, columns; flat, 1 m × 1 m, 0.3 kg
    auto state = cloth.initial_state();
    state.v.row(2).tail(63 * 64).setConstant(20);  // m/s, all but the upper row
    const float before = cloth.energy(state);

    taut::Guarded guard(cloth);
    for (int frame = 0; frame < 60; ++frame) {
        if (!guard.advance(state, 1.0f / 60)) return 1;
    }
    std::printf("%.1f J before, %.1f J after\n", before, cloth.energy(state));
}
