// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "mode.hpp"

namespace taut {

/// Why no stiffness-proportional damping α makes a step stable.
enum class EmptyWindow {
    none,                   ///< the window is not empty
    step_too_large,         ///< h ≥ 2/√k_max: no Rayleigh damping helps [T12]
    mass_damping_too_large  ///< d0 alone is too much for this h
};

/// One sentence for people.
constexpr const char* describe(EmptyWindow reason) {
    switch (reason) {
        case EmptyWindow::none: return "the window is not empty";
        case EmptyWindow::step_too_large:
            return "the step is at or above 2/sqrt(k_max): take a smaller step";
        case EmptyWindow::mass_damping_too_large:
            return "the mass-proportional damping d0 is too large for this step: lower one of them";
    }
    return "unknown reason";
}

/// The open interval (lower, upper) of α, s, that makes a step stable; α = 0 may belong to it too.
struct AlphaWindow {
    double lower = 0;
    double upper = 0;
    EmptyWindow empty = EmptyWindow::none;
    bool includes_zero = false;

    /// Whether `alpha`, s, makes the step stable.
    bool contains(double alpha) const {
        if (empty != EmptyWindow::none) return false;
        return (alpha > lower && alpha < upper) || (alpha == 0 && includes_zero);
    }
};

/// The feasible α of D' = d0 + αK' at step h, s, for eigenvalues of K' in [k_min, k_max] with
/// 0 ≤ k_min, 1/s²: exact [T13]–[T16]. A mode with k = 0 and d0 = 0 is a zero mode and never
/// counts against the window. With k_max = 0 or the implicit method the upper end is infinite.
/// @param compression  a bound on M⁻¹(K⁺ − K), 1/s², 0 unless springs are compressed: the true K,
///                     which explicit Euler sees, weakens its second condition by that [T17]
inline AlphaWindow rayleigh_window(Method method, double h, double d0, double k_min, double k_max,
                                   double compression = 0) {
    require_positive("rayleigh_window", "h", h);
    require_non_negative("rayleigh_window", "d0", d0);
    require_non_negative("rayleigh_window", "k_min", k_min);
    if (!(k_max >= k_min) || !std::isfinite(k_max)) {
        fail("rayleigh_window: k_max is ", k_max, "; it must be finite and >= k_min, ", k_min);
    }
    const double infinity = std::numeric_limits<double>::infinity();
    double d0_above = d0;  // what counts as d0 in the upper end
    if (method == Method::implicit_euler) return {0, infinity, EmptyWindow::none, true};
    const bool is_explicit = method == Method::explicit_euler;
    // Where both are too large the step is to blame: no smaller d0 helps [T12].
    const bool too_long = h * h * (k_max + (is_explicit ? compression : 0)) >= 4;
    const AlphaWindow empty{
        0, 0, too_long ? EmptyWindow::step_too_large : EmptyWindow::mass_damping_too_large, false};
    if (is_explicit) d0_above += h * compression / 2;
    // The mode k = 0 sees d0 alone; with d0 ≥ 2/h only k_min > 0 can leave a window [T15].
    if (k_min == 0 && h * d0_above >= 2) return empty;
    if (k_max == 0) return {0, infinity, EmptyWindow::none, true};

    const auto upper_at = [&](double k) {
        return is_explicit ? h / 2 + (2 / h - d0_above) / k
                           : (4 - 2 * h * d0 - h * h * k) / (2 * h * k);
    };
    AlphaWindow window;
    window.upper = upper_at(k_max);
    if (k_min > 0) window.upper = std::min(window.upper, upper_at(k_min));
    const double lower = is_explicit ? h - d0 / k_max : 0;
    window.lower = std::max(lower, 0.0);
    // α = 0 is explicit Euler with d0 alone: stable when h k_max < d0; symplectic is neutral.
    window.includes_zero = is_explicit ? lower < 0 : true;
    if (window.upper <= window.lower) return empty;
    return window;
}

}  // namespace taut
