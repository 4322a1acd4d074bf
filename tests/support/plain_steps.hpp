// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/conditions/method.hpp>
#include <taut/network/spring_system.hpp>

namespace taut_test {

/// Takes `count` explicit steps of h, s, as the method's formula says, by System::force alone.
template <taut::Method method, class System>
void plain_steps(const System& system, typename System::State& state, typename System::Scalar h,
                 int count) {
    static_assert(method == taut::Method::explicit_euler ||
                      method == taut::Method::symplectic_euler ||
                      method == taut::Method::velocity_verlet,
                  "plain_steps: write the steps of this method");
    typename System::Force f;
    const auto kick = [&](typename System::Scalar time) {
        state.v.array() += time * (f.array().rowwise() * system.inverse_mass().transpose().array());
    };
    const auto update_force = [&] { system.force(state, f); };
    if (method == taut::Method::velocity_verlet && count > 0) update_force();
    for (int i = 0; i < count; ++i) {
        if (method == taut::Method::velocity_verlet) {
            kick(h / 2);
            state.x += h * state.v;
            state.time += h;
            update_force();
            kick(h / 2);
            continue;
        }
        update_force();
        if (method == taut::Method::explicit_euler) state.x += h * state.v;
        kick(h);
        if (method == taut::Method::symplectic_euler) state.x += h * state.v;
        state.time += h;
    }
}

}  // namespace taut_test
