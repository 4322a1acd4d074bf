// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "detail/scalar_mode.hpp"

namespace taut::method {

/// The descriptor of symplectic Euler [T5]; what its members mean: ExplicitEuler.
struct SymplecticEuler {
    static constexpr Method method = Method::symplectic_euler;
    static constexpr const char* name = "symplectic_euler";
    static constexpr int order = 1;
    static constexpr bool is_implicit = false;
    using Limit = LimitedByStiffness;
    static constexpr AnyPose any_pose = AnyPose::limited;

    /// [T10].
    static StepQuadratic step_quadratic(double k, double d, double h) {
        const double hd = h * d;
        const double hhk = h * h * k;
        return {hd + hhk - 2, 1 - hd};
    }
    /// The largest |μ| of that polynomial.
    static double spectral_radius(double k, double d, double h) {
        return taut::conditions_detail::largest_root(step_quadratic(k, d, h));
    }
    /// 4/(d + √(d² + 4k)) [T10].
    static double critical_step(double k, double d) {
        const double root = taut::conditions_detail::discriminant_root(d, k);
        return root < 0 ? std::numeric_limits<double>::infinity() : 2 / (d / 2 + root / 2);
    }
};

}  // namespace taut::method
