// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>
#include <limits>

#include "visit.hpp"

// One scalar mode ẍ + d ẋ + k x = 0 under each integrator: d in 1/s, k in 1/s², h in s.

namespace taut {

/// The coefficients of one step's polynomial [T8], [T10], [T11]. BDF2 has four multipliers to a
/// mode: for what has no quadratic the call fails.
inline StepQuadratic step_quadratic(Method method, double k, double d, double h) {
    return method::visit(method, [&](auto descriptor) -> StepQuadratic {
        using Descriptor = decltype(descriptor);
        if constexpr (method::is_absent_v<decltype(Descriptor::step_quadratic)>) {
            fail("step_quadratic: ", Descriptor::name, " has more than two multipliers to a mode");
        } else {
            return Descriptor::step_quadratic(k, d, h);
        }
    });
}

/// The two multipliers μ of one step; fails as step_quadratic does.
inline std::array<std::complex<double>, 2> multipliers(Method method, double k, double d,
                                                       double h) {
    return conditions_detail::roots(step_quadratic(method, k, d, h));
}

/// Largest modulus of the multipliers.
inline double spectral_radius(Method method, double k, double d, double h) {
    return method::visit(
        method, [&](auto descriptor) { return decltype(descriptor)::spectral_radius(k, d, h); });
}

/// The largest step of one mode: exactly the h in (0, h_max) give |μ| < 1 [T9], [T10], [T11], [T29]
/// (symplectic with d = 0: |μ| = 1). 0 when no step is stable, infinity when every one is.
/// A buckled mode (k < 0) gets the limit that the step adds to its physical growth [T27].
inline double critical_step(Method method, double k, double d) {
    // A zero mode: its multiplier is exactly 1.
    if (k == 0 && d == 0) return std::numeric_limits<double>::infinity();
    return method::visit(
        method, [&](auto descriptor) { return decltype(descriptor)::critical_step(k, d); });
}

}  // namespace taut
