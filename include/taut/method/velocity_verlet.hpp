// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "symplectic_euler.hpp"

namespace taut::method {

/// The descriptor of velocity Verlet. With damping taken at the half step it is symplectic Euler in
/// (x, v at the half step), so it shares that one's multipliers and limits.
struct VelocityVerlet : SymplecticEuler {
    static constexpr Method method = Method::velocity_verlet;
    static constexpr const char* name = "velocity_verlet";
    static constexpr int order = 2;  ///< undamped; 1 with damping
    static constexpr bool averages_forces = true;

    /// H − ⅛h² fᵀM⁻¹f + ½h v_p·f_p + ¼h vᵀDv with p the pins, J [T36].
    template <class Books>
    static double kept_energy(const Books& books, double h) {
        return books.total() - h * h / 8 * books.force_norm + h / 2 * books.pin_power +
               h / 4 * books.braking(h);
    }
    /// ½h of the pins' power, less ⅛h² of what gravity adds to fᵀM⁻¹f, J.
    template <class Books>
    static double energy_lag(const Books& books, double h) {
        return h / 2 * books.pin_power - h * h / 8 * (books.force_norm - books.pull_norm);
    }
    /// [1 − s, 1 + 2b] with s the share, b braked.
    static EnergyBand energy_band(double share, double braked) {
        return {1 - share, 1 + 2 * braked};
    }
};

}  // namespace taut::method
