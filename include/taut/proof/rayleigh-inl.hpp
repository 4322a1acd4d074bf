// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/error.hpp"
#include "../conditions/visit.hpp"
#include "rayleigh.hpp"

namespace taut {
namespace proof_detail {

/// Above the exact result of the operation, of two for a division, that gave `value` …
inline double above(double value) {
    for (int i = 0; i < 3; ++i)
        value = std::nextafter(value, std::numeric_limits<double>::infinity());
    return value;
}
/// … and below.
inline double below(double value) { return -above(-value); }

/// The ends of rayleigh_window for an explicit method, its reason apart, rounded inwards: whether
/// any α is left.
/// @param is_explicit  explicit Euler, not symplectic
inline bool explicit_ends(bool is_explicit, double h, double d0, double k_min, double k_max,
                          double compression, AlphaWindow& window) {
    // What counts as d0 in the upper end.
    const double d0_above =
        is_explicit && compression > 0 ? above(d0 + above(above(h * compression) / 2)) : d0;
    // The mode k = 0 sees d0 alone; with d0 ≥ 2/h only k_min > 0 can leave a window [T15]. One
    // rounding keeps the sign, which two would not.
    const double budget = std::fma(-h, d0_above, 2.0);
    if (k_min == 0 && !(budget > 0)) return false;
    if (k_max == 0) {
        window = {0, std::numeric_limits<double>::infinity(), EmptyWindow::none, true};
        return true;
    }
    const auto upper_at = [&](double k) {
        const double quotient = below(below(below(budget) / h) / k);  // (2/h − d0)/k
        return below(is_explicit ? below(h / 2) + quotient : quotient - above(h / 2));
    };
    window.upper = upper_at(k_max);
    if (k_min > 0) window.upper = (std::min)(window.upper, upper_at(k_min));
    window.lower = 0;
    if (is_explicit) {
        const double least = d0 > 0 ? above(h - below(d0 / k_max)) : h;
        window.lower = (std::max)(least, 0.0);
    }
    // α = 0 is explicit Euler with d0 alone: stable when h k_max < d0; symplectic is neutral.
    window.includes_zero = !is_explicit || std::fma(h, k_max, -d0) < 0;
    return window.upper > window.lower;
}

inline AlphaWindow explicit_window(bool is_explicit, double h, double d0, double k_min,
                                   double k_max, double compression) {
    AlphaWindow window;
    if (explicit_ends(is_explicit, h, d0, k_min, k_max, compression, window)) return window;
    // Where both are too large the step is to blame: no smaller d0 helps [T12].
    const bool helps = explicit_ends(is_explicit, h, 0, k_min, k_max, compression, window);
    return {0, 0, helps ? EmptyWindow::mass_damping_too_large : EmptyWindow::step_too_large, false};
}

// rayleigh_window by what limits the method.
inline AlphaWindow window_by(method::LimitedByDamping, double h, double d0, double k_min,
                             double k_max, double compression) {
    return explicit_window(true, h, d0, k_min, k_max, compression);
}
inline AlphaWindow window_by(method::LimitedByStiffness, double h, double d0, double k_min,
                             double k_max, double compression) {
    return explicit_window(false, h, d0, k_min, k_max, compression);
}
inline AlphaWindow window_by(method::LimitedByIndefiniteness, double, double, double, double,
                             double) {
    return {0, std::numeric_limits<double>::infinity(), EmptyWindow::none, true};
}

}  // namespace proof_detail

TAUT_INLINE AlphaWindow rayleigh_window(Method method, double h, double d0, double k_min,
                                        double k_max, double compression) {
    require_positive("rayleigh_window", "h", h);
    require_non_negative("rayleigh_window", "d0", d0);
    require_non_negative("rayleigh_window", "k_min", k_min);
    if (!(k_max >= k_min) || !detail::is_finite(k_max)) {
        fail("rayleigh_window: k_max is ", k_max, "; it must be finite and >= k_min, ", k_min);
    }
    return method::visit_limited("rayleigh_window", method, [&](auto descriptor) {
        using Limit = typename decltype(descriptor)::Limit;
        return proof_detail::window_by(Limit{}, h, d0, k_min, k_max, compression);
    });
}

TAUT_INLINE double damping_ratio(const RayleighDamping& rayleigh, double omega) {
    if (!(omega > 0) || !detail::is_finite(omega)) {
        fail("damping_ratio: omega is ", omega, "; it must be finite and > 0");
    }
    return rayleigh.mass_proportional / (2 * omega) + rayleigh.stiffness_proportional * omega / 2;
}

}  // namespace taut
