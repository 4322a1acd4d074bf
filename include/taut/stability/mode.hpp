// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "../core/error.hpp"
#include "../core/method.hpp"

// One scalar mode ẍ + d ẋ + k x = 0 under each integrator: d in 1/s, k in 1/s², h in s.

namespace taut {
namespace detail {

/// √(d² + 4k), −1 where there is none: in a unit of time, a power of two, in which neither square
/// can vanish or overflow.
inline double discriminant_root(double d, double k) {
    const double size = std::max(std::abs(d), std::sqrt(std::abs(k)));
    const int unit = size > 0 && std::isfinite(size) ? std::ilogb(size) : 0;
    d = std::scalbn(d, -unit);
    k = std::scalbn(std::scalbn(k, -unit), -unit);
    return d * d + 4 * k < 0 ? -1 : std::scalbn(std::sqrt(d * d + 4 * k), unit);
}

}  // namespace detail

/// The characteristic polynomial μ² + b μ + c of one step on one mode.
struct StepQuadratic {
    double b;
    double c;
};

/// Its coefficients [T8], [T10], [T11]. Velocity Verlet with damping taken at the half step is
/// symplectic Euler in (x, v at the half step), so it shares that polynomial.
inline StepQuadratic step_quadratic(Method method, double k, double d, double h) {
    const double hd = h * d;
    const double hhk = h * h * k;
    switch (method) {
        case Method::explicit_euler: return {hd - 2, 1 - hd + hhk};
        case Method::symplectic_euler:
        case Method::velocity_verlet: return {hd + hhk - 2, 1 - hd};
        case Method::implicit_euler: return {-(2 + hd) / (1 + hd + hhk), 1 / (1 + hd + hhk)};
    }
    fail("step_quadratic: unknown method");
}

/// The two multipliers μ of one step.
inline std::array<std::complex<double>, 2> multipliers(Method method, double k, double d,
                                                       double h) {
    const auto [b, c] = step_quadratic(method, k, d, h);
    const double real_root = detail::discriminant_root(b, -c);
    if (real_root < 0) {
        const std::complex<double> root(-b / 2, std::sqrt(std::max(0.0, 4 * c - b * b)) / 2);
        return {root, std::conj(root)};
    }
    // The root of larger modulus first: the other one follows without cancellation.
    const double large = -(b + std::copysign(real_root, b)) / 2;
    return {large, large == 0 ? 0 : c / large};
}

/// Largest modulus of the two multipliers.
inline double spectral_radius(Method method, double k, double d, double h) {
    const auto mu = multipliers(method, k, d, h);
    return std::max(std::abs(mu[0]), std::abs(mu[1]));
}

/// The largest step of one mode: exactly the h in (0, h_max) give |μ| < 1 [T9], [T10], [T11]
/// (symplectic with d = 0: |μ| = 1). 0 when no step is stable, infinity when every one is.
/// A buckled mode (k < 0) gets the limit that the step adds to its physical growth [T27].
inline double critical_step(Method method, double k, double d) {
    const double infinity = std::numeric_limits<double>::infinity();
    if (k == 0 && d == 0) return infinity;  // a zero mode: its multiplier is exactly 1
    switch (method) {
        case Method::explicit_euler: {
            const double root = detail::discriminant_root(d, -k);
            return root < 0 ? d / k : 2 / (d / 2 + root / 2);
        }
        case Method::symplectic_euler:
        case Method::velocity_verlet: {
            const double root = detail::discriminant_root(d, k);
            return root < 0 ? infinity : 2 / (d / 2 + root / 2);
        }
        case Method::implicit_euler:
            if (k >= 0) return infinity;
            // The root of 1 + hd + h²k [T21].
            return (d / 2 + detail::discriminant_root(d, -k) / 2) / -k;
    }
    fail("critical_step: unknown method");
}

}  // namespace taut
