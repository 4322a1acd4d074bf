// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "../../core/detail/finite.hpp"
#include "../method.hpp"

// Roots of one scalar mode ẍ + d ẋ + k x = 0: d in 1/s, k in 1/s².

namespace taut::conditions_detail {

/// √(d² + 4k), −1 where there is none: in a unit of time, a power of two, in which neither square
/// can vanish or overflow.
inline double discriminant_root(double d, double k) {
    const double size = (std::max)((std::abs)(d), std::sqrt((std::abs)(k)));
    const int unit = size > 0 && detail::is_finite(size) ? std::ilogb(size) : 0;
    d = std::scalbn(d, -unit);
    k = std::scalbn(std::scalbn(k, -unit), -unit);
    return d * d + 4 * k < 0 ? -1 : std::scalbn(std::sqrt(d * d + 4 * k), unit);
}

/// Both roots of μ² + bμ + c.
inline std::array<std::complex<double>, 2> roots(const StepQuadratic& polynomial) {
    const auto [b, c] = polynomial;
    const double real_root = discriminant_root(b, -c);
    if (real_root < 0) {
        const std::complex<double> root(-b / 2, std::sqrt((std::max)(0.0, 4 * c - b * b)) / 2);
        return {root, std::conj(root)};
    }
    // The root of larger modulus first: the other one follows without cancellation.
    const double large = -(b + std::copysign(real_root, b)) / 2;
    return {large, large == 0 ? 0 : c / large};
}

/// The larger modulus of the two.
inline double largest_root(const StepQuadratic& polynomial) {
    const auto mu = roots(polynomial);
    return (std::max)((std::abs)(mu[0]), (std::abs)(mu[1]));
}

}  // namespace taut::conditions_detail
