// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../core/detail/bisection.hpp"
#include "../../conditions/mode.hpp"
#include "../pencil.hpp"

// Explicit Euler: D − hK⁺ ≻ 0 and 4M − 2hD + h²K ≻ 0, or mode by mode where M, D and K commute.

namespace taut::proof_detail {

/// Whether the two sufficient conditions of explicit Euler hold at h by the bound [T17]:
/// D − hK⁺ ≻ 0 and 4M − 2hD + h²K ≻ 0. The second one needs the true K, since K ⪯ K⁺.
inline bool certifies_explicit(const Pencil& pencil, double h) {
    const double strict = h * (1 + 1e-9);
    return pencil.upper_bound(strict * K_plus - D) <= 0 &&
           pencil.upper_bound(2 * h * D - h * h * K) < 4;
}

/// The limit of explicit Euler on one mode [T9], from below and from above.
struct ModeLimit {
    double lower = 0;
    double upper = infinity;
};

/// @param k, d  1/s², 1/s, each as computed. Near critical damping, d² = 4k, the limit moves by the
///              root of what their rounding moves d² − 4k by: 1e-8.
inline ModeLimit explicit_mode_limit(double k, double d) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const double softer = k - rounding * (std::abs)(k);
    const double stiffer = k + rounding * (std::abs)(k);
    const double less = d - rounding * (std::abs)(d);
    const double more = d + rounding * (std::abs)(d);
    const auto overdamped = [](double k_mode, double d_mode) {
        return d_mode >= 2 * std::sqrt((std::max)(k_mode, 0.0));
    };
    // It rises with k and falls with d on one side of critical damping, the other way round on the
    // other, so that corners decide; in between it is largest where d² = 4k, 4/d.
    const double one = critical_step(Method::explicit_euler, stiffer, less);
    const double other = critical_step(Method::explicit_euler, softer, more);
    const bool across = overdamped(stiffer, less) != overdamped(softer, more);
    return {(std::min)(one, other), across ? 4 / less : (std::max)(one, other)};
}

/// The largest step that proved bounds k on k_max and d on the largest eigenvalue of D' certify for
/// explicit Euler, or else the bound at each step tried; 0: none.
inline double certified_explicit(const Pencil& pencil, double k, double d) {
    if (!detail::is_finite(k)) return 0;
    const auto [d0, alpha] = pencil.rayleigh();
    if (pencil.is_rayleigh() && pencil.stiffness_semidefinite()) {
        // k may be anything in (0, k_max]: as k → 0 the limit is 2/d0 [T9], [T13], or α where d0 =
        // 0, which the limit of no k exceeds. Where rounding leaves springs slightly compressed, by
        // κ: 4 − 2hd0 − h²κ ≥ 0 [T17].
        if (!(k > 0)) return critical_step(Method::explicit_euler, 0, d0);
        const double at_zero = critical_step(Method::symplectic_euler, pencil.compression(), d0);
        return (std::min)(at_zero, explicit_mode_limit(k, d0 + alpha * k).lower);
    }
    // The stable steps are an interval (0, h_max) [T18]. Where damping is weak it ends near the
    // limit that K alone sets for any commuting damping [T12].
    const auto certifies = [&](double h) { return certifies_explicit(pencil, h); };
    if (!certifies((std::numeric_limits<double>::min)())) return 0;
    return detail::last_that_passes(k > 0 ? 2 / std::sqrt(k) : 4 / d, 1e-4, certifies);
}

/// What the answer of explicit Euler is set by. @param k  a bound on k_max, 1/s²
inline Cause explicit_cause(const UnroundedLimit& limit, double k) {
    const bool by_damping = k <= 0 || limit.certified * limit.certified * k < 4 * (1 - 1e-3);
    if (limit.certified > 0) return by_damping ? Cause::damping : Cause::stiffness;
    return limit.certified_up_to > 0 ? Cause::rounding : Cause::undamped_modes;
}

/// The certified step by bounds alone; no vector is looked for that refutes.
/// @param k, d  bounds on k_max, 1/s², and on the largest eigenvalue of D', 1/s
inline UnroundedLimit explicit_by_bounds(const Pencil& pencil, double k, double d) {
    // A negative K or D of bare matrices is not nothing.
    if (!(k > 0) && !(d > 0) && pencil.upper_bound(-K) <= 0 && pencil.upper_bound(-D) <= 0) {
        return {infinity, infinity, Cause::nothing_to_limit};
    }
    if (!detail::is_finite(k) || !detail::is_finite(d)) return {0, infinity, Cause::overflow};
    if (!(d > 0)) return {0, infinity, Cause::undamped};
    UnroundedLimit limit;
    limit.certified = certified_explicit(pencil, k, d);
    limit.cause = explicit_cause(limit, k);
    return limit;
}

}  // namespace taut::proof_detail
