// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A cloth, the step at which it cannot gain energy, and a thousand such steps.

#include <cstdio>
#include <taut/taut.hpp>

int main() {
    auto cloth = taut::hanging_cloth<double>({64, 64});  // 1 m × 1 m, 0.3 kg
    auto state = cloth.initial_state();

    auto limit = taut::energy_limit(cloth);
    std::printf("no step up to about %.4g s gains energy\n", limit.certified);

    taut::EnergyStableEuler stepper(cloth);
    if (auto report = stepper.step(state, limit.certified, 1000); !report) {
        std::printf("particle %d: %s\n", int(report.where), describe(report.status));
        return 1;
    }
    std::printf("after %.3f s the energy is %.2e J\n", state.time, cloth.energy(state));
}
