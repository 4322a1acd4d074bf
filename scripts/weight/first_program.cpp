// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// README's first program much as it was when the weight was first measured. Kept apart, so that a
// shorter README makes nothing lighter.

#include <cstdio>
#include <taut/taut.hpp>

int main() {
    taut::SpringSystem<double, 3> cloth =
        taut::hanging_cloth<double>({64, 64});  // 1 m × 1 m, 0.3 kg
    auto state = cloth.initial_state();

    taut::Stability<double> stability(cloth, state);
    auto limit = stability.max_step(taut::Method::symplectic_euler);
    std::printf("at this pose: %.4g s is proved stable\n", limit.certified);

    auto alpha = stability.rayleigh_window(taut::Method::explicit_euler, 1e-4);
    std::printf("explicit Euler at 1e-4 s needs alpha in (%.4g, %.4g) s\n", alpha.lower,
                alpha.upper);

    auto moving = taut::energy_limit(cloth);
    taut::EnergyStableEuler stepper(cloth);
    for (int i = 0; i < 1000; ++i) {
        if (auto report = stepper.step(state, moving.certified); !report) {
            std::printf("particle %d: %s\n", int(report.where), describe(report.status));
            return 1;
        }
    }
    std::printf("after %.3f s the energy is %.2e J\n", state.time, cloth.energy(state));
}
