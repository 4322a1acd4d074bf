// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "detail/scalar_mode.hpp"

namespace taut::method {

/// The descriptor of implicit Euler [T6], [T27]; what its members mean: ExplicitEuler.
struct ImplicitEuler {
    static constexpr Method method = Method::implicit_euler;
    static constexpr const char* name = "implicit_euler";
    static constexpr int order = 1;
    static constexpr bool is_implicit = true;
    using Limit = LimitedByIndefiniteness;
    static constexpr AnyPose any_pose = AnyPose::every_step;

    /// [T11].
    static StepQuadratic step_quadratic(double k, double d, double h) {
        const double hd = h * d;
        const double hhk = h * h * k;
        return {-(2 + hd) / (1 + hd + hhk), 1 / (1 + hd + hhk)};
    }
    /// The largest |μ| of that polynomial.
    static double spectral_radius(double k, double d, double h) {
        return taut::conditions_detail::largest_root(step_quadratic(k, d, h));
    }
    /// Infinity; for k < 0 the root of 1 + hd + h²k [T21].
    static double critical_step(double k, double d) {
        if (k >= 0) return std::numeric_limits<double>::infinity();
        return (d / 2 + taut::conditions_detail::discriminant_root(d, -k) / 2) / -k;
    }
};

}  // namespace taut::method
