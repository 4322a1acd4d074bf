// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "detail/scalar_mode.hpp"

namespace taut::method {

/// The descriptor of explicit Euler [T4], and the model of all: every descriptor has these members.
struct ExplicitEuler {
    static constexpr Method method = Method::explicit_euler;
    /// As tables, sentences and the programs' JSON spell it.
    static constexpr const char* name = "explicit_euler";
    static constexpr int order = 1;
    /// Whether a step solves a linear system; its forces are then those at its end.
    static constexpr bool is_implicit = false;
    /// What holds a step down at one pose, or Absent.
    using Limit = LimitedByDamping;
    /// Which steps are safe at every pose.
    static constexpr AnyPose any_pose = AnyPose::no_step;

    /// Of one step of h, s, on ẍ + dẋ + kx = 0, d in 1/s and k in 1/s² [T8]; or Absent.
    static StepQuadratic step_quadratic(double k, double d, double h) {
        const double hd = h * d;
        const double hhk = h * h * k;
        return {hd - 2, 1 - hd + hhk};
    }
    /// The largest |μ| of such a step.
    static double spectral_radius(double k, double d, double h) {
        return taut::conditions_detail::largest_root(step_quadratic(k, d, h));
    }
    /// As taut::critical_step, where k and d are not both 0: d/k, or 4/(d + √(d² − 4k)) [T9].
    static double critical_step(double k, double d) {
        const double root = taut::conditions_detail::discriminant_root(d, -k);
        return root < 0 ? d / k : 2 / (d / 2 + root / 2);
    }
};

}  // namespace taut::method
