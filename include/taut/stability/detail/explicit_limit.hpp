// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../core/detail/bisection.hpp"
#include "../../method/mode.hpp"
#include "effort.hpp"

// Explicit Euler: D − hK⁺ ≻ 0 and 4M − 2hD + h²K ≻ 0, or mode by mode where M, D and K commute.

namespace taut::stability_detail {

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
    const double softer = k - rounding * std::abs(k);
    const double stiffer = k + rounding * std::abs(k);
    const double less = d - rounding * std::abs(d);
    const double more = d + rounding * std::abs(d);
    const auto overdamped = [](double k_mode, double d_mode) {
        return d_mode >= 2 * std::sqrt(std::max(k_mode, 0.0));
    };
    // It rises with k and falls with d on one side of critical damping, the other way round on the
    // other, so that corners decide; in between it is largest where d² = 4k, 4/d.
    const double one = critical_step(Method::explicit_euler, stiffer, less);
    const double other = critical_step(Method::explicit_euler, softer, more);
    const bool across = overdamped(stiffer, less) != overdamped(softer, more);
    return {std::min(one, other), across ? 4 / less : std::max(one, other)};
}

/// The largest limit of explicit Euler that a mode with k in [low, high], 1/s², can have. The modes
/// that are stable at one step are an interval of k (section 4), so the limit has one peak: at
/// critical damping, √k = d0/(1 + √(1 − αd0)), as far as d0 > 0.
inline double largest_explicit_limit(const RayleighDamping& rayleigh, double low, double high) {
    const auto [d0, alpha] = rayleigh;
    if (d0 == 0 && low <= 0 && high >= 0) return infinity;  // it may be a zero mode
    double largest = std::max(explicit_mode_limit(low, d0 + alpha * low).upper,
                              explicit_mode_limit(high, d0 + alpha * high).upper);
    if (d0 > 0 && alpha * d0 < 1) {
        const double root = d0 / (1 + std::sqrt(1 - alpha * d0));
        if (root * root > low && root * root < high) {
            // 1 − αd0 rounds as well.
            const double from = 1 - alpha * d0 + 4 * std::numeric_limits<double>::epsilon();
            largest = std::max(largest, 2 * (1 + std::sqrt(from)) / d0);
        }
    }
    return largest;
}

/// The largest step that proved bounds k on k_max and d on the largest eigenvalue of D' certify for
/// explicit Euler, or else the bound at each step tried; 0: none.
inline double certified_explicit(const Pencil& pencil, double k, double d) {
    if (!std::isfinite(k)) return 0;
    const auto [d0, alpha] = pencil.rayleigh();
    if (pencil.is_rayleigh() && pencil.stiffness_semidefinite()) {
        // k may be anything in (0, k_max]: as k → 0 the limit is 2/d0, or α when d0 = 0 [T9],
        // [T13]. Where rounding leaves springs slightly compressed, by κ: 4 − 2hd0 − h²κ ≥ 0 [T17].
        if (!(k > 0)) return critical_step(Method::explicit_euler, 0, d0);
        const double at_zero = critical_step(Method::symplectic_euler, pencil.compression(), d0);
        return std::min(
            {at_zero, d0 > 0 ? infinity : alpha, explicit_mode_limit(k, d0 + alpha * k).lower});
    }
    // The stable steps are an interval (0, h_max) [T18]. Where damping is weak it ends near the
    // limit that K alone sets for any commuting damping [T12].
    const auto certifies = [&](double h) { return certifies_explicit(pencil, h); };
    if (!certifies(std::numeric_limits<double>::min())) return 0;
    return detail::last_that_passes(k > 0 ? 2 / std::sqrt(k) : 4 / d, 1e-4, certifies);
}

/// uᵀ(4M − 2hD + h²K)u ≤ 0 proves a multiplier ≤ −1 of explicit Euler, for any symmetric D and K.
inline double refuted_by_damping(const Pencil& pencil, const Eigen::VectorXd& u) {
    const auto [k_enclosed, d_enclosed] = quotients(pencil, u, K);
    const double k = k_enclosed.upper();
    const double d = std::max(0.0, d_enclosed.lower());
    const double root = method_detail::discriminant_root(d, -k);
    return d > 0 && root >= 0 ? 2 / (d / 2 + root / 2) : infinity;
}

/// @param commutes  whether M, D and the stepper's K share their eigenvectors
template <class Real = double>
double refuted_explicit(const Pencil& pencil, const RitzPair& stiffest, bool commutes) {
    const RitzPair most_damped = largest_ritz_pair(pencil, D);
    double h = std::min(refuted_by_damping(pencil, stiffest.vector),
                        refuted_by_damping(pencil, most_damped.vector));
    if (!commutes) return h;
    // Every Rayleigh quotient of K' lies in [k_min, k_max], and where [T8] fails at one of these it
    // fails at an end of the spectrum [T13].
    const auto refuted_by = [&](const RitzPair& mode) {
        const Enclosed k = quotients(pencil, mode.vector, K).k;
        return largest_explicit_limit(pencil.rayleigh(), k.lower(), k.upper());
    };
    h = std::min(h, refuted_by(stiffest));
    if (pencil.rayleigh().mass_proportional > 0) {
        h = std::min(h, refuted_by(largest_ritz_pair(pencil, -K)));
    }
    return h;
}

/// Whether M, D and the stepper's K share their eigenvectors: α K⁺ is not a function of an
/// indefinite K, so there only d0·M commutes with it.
inline bool commutes(const Pencil& pencil) {
    return pencil.is_rayleigh() &&
           (pencil.stiffness_semidefinite() || pencil.rayleigh().stiffness_proportional == 0);
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
    if (!std::isfinite(k) || !std::isfinite(d)) return {0, infinity, Cause::overflow};
    if (!(d > 0)) return {0, infinity, Cause::undamped};
    UnroundedLimit limit;
    limit.certified = certified_explicit(pencil, k, d);
    limit.cause = explicit_cause(limit, k);
    return limit;
}

/// The bracket of the largest stable step. @param stiffest  the stiffest mode of K⁺ known
template <class Effort>
UnroundedLimit explicit_bracket(const Pencil& pencil, Effort& effort, const RitzPair& stiffest) {
    const double k = pencil.upper_bound(K_plus);
    UnroundedLimit limit = explicit_by_bounds(pencil, k, pencil.upper_bound(D));
    if (limit.cause == Cause::nothing_to_limit || limit.cause == Cause::overflow) return limit;
    if (limit.cause == Cause::undamped) {
        // One mode with k > 0 refutes every step; buckled modes alone do not.
        if (quotients(pencil, stiffest.vector, K).k.lower() > 0) limit.refuted = 0;
        return limit;
    }
    limit.refuted = refuted_explicit(pencil, stiffest, commutes(pencil));
    effort.narrow_explicit(pencil, stiffest, limit);
    limit.cause = explicit_cause(limit, k);
    limit.refuted = std::max(limit.refuted, limit.certified);
    return limit;
}

}  // namespace taut::stability_detail
