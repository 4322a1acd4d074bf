// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "account.hpp"

namespace taut_test::mass_scaling_test {

/// With the mass added the step is certified, and none is where it is already: of the scenes of
/// these dimensions.
template <int... Dims>
void check_scenes() {
    for (const double factor : {0.5, 1.001, 1.1, 2.0, 10.0}) {
        for_each_scene<double, Dims...>([&](const std::string& scene, const auto& system,
                                            const auto& state) {
            const double omega = Multipliers(exact_matrices(system, state.x)).omega();
            for_each_damping(system, omega, [&](const std::string& damping, const auto& damped) {
                const auto limit =
                    Stability<double>(damped, state).max_step(Method::symplectic_euler);
                const double h = std::isfinite(limit.certified) ? factor * limit.certified : 1e3;
                const auto added = added_mass(damped, state, h);
                INFO(scene << ", " << damping << ", " << factor << " times the step");
                check_account(damped, added);
                const bool possible = h * damped.rayleigh().mass_proportional < 2;
                CHECK(added.reached == possible);
                if (!possible || h <= limit.certified) {
                    CHECK(added.total == 0);
                    for (const double change : added.frequency_change) CHECK(change == 0);
                    return;
                }
                if (h > limit.refuted * (1 + 1e-9)) CHECK(added.total > 0);
                const Stability<double> heavier(with_added(damped, added), state);
                CHECK(taut::certify(heavier, Method::symplectic_euler, h).proved);
                CHECK(taut::certify(heavier, Method::velocity_verlet, h).proved);
            });
        });
    }
}

}  // namespace taut_test::mass_scaling_test
