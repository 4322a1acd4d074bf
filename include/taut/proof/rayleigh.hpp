// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../conditions/method.hpp"
#include "../network/damping.hpp"

namespace taut {

/// Why no stiffness-proportional damping α makes a step stable.
enum class EmptyWindow {
    none,                    ///< the window is not empty
    step_too_large,          ///< h ≥ 2/√k_max: no Rayleigh damping helps [T12]
    mass_damping_too_large,  ///< d0 alone is too much for this h
    overflow                 ///< k_max is too large for double: nothing is proved
};

/// One sentence for people.
constexpr const char* describe(EmptyWindow reason) {
    switch (reason) {
        case EmptyWindow::none: return "the window is not empty";
        case EmptyWindow::step_too_large:
            return "the step is at or above 2/sqrt(k_max): take a smaller step";
        case EmptyWindow::mass_damping_too_large:
            return "the mass-proportional damping d0 is too large for this step: lower one of them";
        case EmptyWindow::overflow:
            return "the numbers of this scene overflow in double: check the units of its stiffness "
                   "and masses";
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
/// 0 ≤ k_min, 1/s²: exact [T13]–[T16], but for its own rounding, which is inwards: whatever the
/// window contains is stable. A mode with k = 0 and d0 = 0 is a zero mode and never counts against
/// the window. With k_max = 0 or implicit Euler the upper end is infinite. BDF2 and the
/// energy-stable Euler step are refused.
/// @param compression  a bound on M⁻¹(K⁺ − K), 1/s², 0 unless springs are compressed: the true K,
///                     which explicit Euler sees, weakens its second condition by that [T17]
AlphaWindow rayleigh_window(Method method, double h, double d0, double k_min, double k_max,
                            double compression = 0);

/// ζ = d0/(2ω) + αω/2, the damping ratio of Rayleigh damping at angular frequency ω, rad/s, which
/// must be finite and > 0.
double damping_ratio(const RayleighDamping& rayleigh, double omega);

}  // namespace taut

#if !defined(TAUT_COMPILED)
#include "rayleigh-inl.hpp"
#endif
