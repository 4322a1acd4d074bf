// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "symplectic_euler.hpp"

namespace taut::method {

/// The descriptor of the energy-stable Euler step [T42]; what its members mean: ExplicitEuler. In
/// the linear it is symplectic Euler with D + hK⁺, since springs push along their old direction.
/// What is proved of it holds at every pose and speed: no limit is asked for at one.
struct EnergyStableEuler {
    static constexpr Method method = Method::energy_stable_euler;
    static constexpr const char* name = "energy_stable_euler";
    static constexpr int order = 1;
    static constexpr bool is_implicit = false;
    using Limit = Absent;
    static constexpr AnyPose any_pose = AnyPose::proved;

    /// [T10] with d + hk⁺ in place of d.
    static StepQuadratic step_quadratic(double k, double d, double h) {
        return SymplecticEuler::step_quadratic(k, d + h * (std::max)(0.0, k), h);
    }
    /// The largest |μ| of that polynomial.
    static double spectral_radius(double k, double d, double h) {
        return taut::conditions_detail::largest_root(step_quadratic(k, d, h));
    }
    /// That of 4 − 2hd − 3h²k⁺ + h²k⁻ = 0 [T10].
    static double critical_step(double k, double d) {
        return SymplecticEuler::critical_step(k > 0 ? 3 * k : k, d);
    }
};

}  // namespace taut::method
