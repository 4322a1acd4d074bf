// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "implicit_euler.hpp"

namespace taut::method {

/// The descriptor of BDF2 at equal steps [T29]; what its members mean: ExplicitEuler. Each root λ
/// of a mode has the two multipliers 1/(2 ± √(1 + 2hλ)), of modulus ≤ 1 for Re λ ≤ 0, so there are
/// four to a mode and no quadratic. Beside compressed springs nothing is proved of it.
struct Bdf2 {
    static constexpr Method method = Method::bdf2;
    static constexpr const char* name = "bdf2";
    static constexpr int order = 2;
    static constexpr bool is_implicit = true;
    using Limit = Absent;
    static constexpr AnyPose any_pose = AnyPose::every_step;

    static constexpr Absent step_quadratic{};
    /// The largest 1/|2 − √(1 + 2hλ)|.
    static double spectral_radius(double k, double d, double h) {
        double radius = 0;
        for (const auto& lambda : taut::conditions_detail::roots({d, k}))
            radius = (std::max)(radius, 1 / (std::abs)(2.0 - std::sqrt(1.0 + 2 * h * lambda)));
        return radius;
    }
    /// Infinity; for k < 0 where 1 + τd + τ²k = 0, τ = ⅔h.
    static double critical_step(double k, double d) {
        return 1.5 * ImplicitEuler::critical_step(k, d);
    }
};

}  // namespace taut::method
