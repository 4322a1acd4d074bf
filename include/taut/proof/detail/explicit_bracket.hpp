// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../conditions/mode.hpp"
#include "effort.hpp"
#include "explicit_limit.hpp"

// What refutes steps of explicit Euler: a vector, or a mode where M, D and K commute.

namespace taut::proof_detail {

/// The largest limit of explicit Euler that a mode with k in [low, high], 1/s², can have. The modes
/// that are stable at one step are an interval of k [T13], so the limit has one peak: at
/// critical damping, √k = d0/(1 + √(1 − αd0)), as far as d0 > 0.
inline double largest_explicit_limit(const RayleighDamping& rayleigh, double low, double high) {
    const auto [d0, alpha] = rayleigh;
    if (d0 == 0 && low <= 0 && high >= 0) return infinity;  // it may be a zero mode
    double largest = (std::max)(explicit_mode_limit(low, d0 + alpha * low).upper,
                                explicit_mode_limit(high, d0 + alpha * high).upper);
    if (d0 > 0 && alpha * d0 < 1) {
        const double root = d0 / (1 + std::sqrt(1 - alpha * d0));
        if (root * root > low && root * root < high) {
            // 1 − αd0 rounds as well.
            const double from = 1 - alpha * d0 + 4 * std::numeric_limits<double>::epsilon();
            largest = (std::max)(largest, 2 * (1 + std::sqrt(from)) / d0);
        }
    }
    return largest;
}

/// uᵀ(4M − 2hD + h²K)u ≤ 0 proves a multiplier ≤ −1 of explicit Euler, for any symmetric D and K.
inline double refuted_by_damping(const Pencil& pencil, const Eigen::VectorXd& u) {
    const auto [k_enclosed, d_enclosed] = quotients(pencil, u, K);
    const double k = k_enclosed.upper();
    const double d = (std::max)(0.0, d_enclosed.lower());
    const double root = conditions_detail::discriminant_root(d, -k);
    return d > 0 && root >= 0 ? 2 / (d / 2 + root / 2) : infinity;
}

/// @param commutes  whether M, D and the stepper's K share their eigenvectors
template <class Real = double>
double refuted_explicit(const Pencil& pencil, const RitzPair& stiffest, bool commutes) {
    const RitzPair most_damped = largest_ritz_pair(pencil, D);
    double h = (std::min)(refuted_by_damping(pencil, stiffest.vector),
                          refuted_by_damping(pencil, most_damped.vector));
    if (!commutes) return h;
    // Every Rayleigh quotient of K' lies in [k_min, k_max], and where [T8] fails at one of these it
    // fails at an end of the spectrum [T13].
    const auto refuted_by = [&](const RitzPair& mode) {
        const Enclosed k = quotients(pencil, mode.vector, K).k;
        return largest_explicit_limit(pencil.rayleigh(), k.lower(), k.upper());
    };
    h = (std::min)(h, refuted_by(stiffest));
    if (pencil.rayleigh().mass_proportional > 0) {
        h = (std::min)(h, refuted_by(largest_ritz_pair(pencil, -K)));
    }
    return h;
}

/// Whether M, D and the stepper's K share their eigenvectors: α K⁺ is not a function of an
/// indefinite K, so there only d0·M commutes with it.
inline bool commutes(const Pencil& pencil) {
    return pencil.is_rayleigh() &&
           (pencil.stiffness_semidefinite() || pencil.rayleigh().stiffness_proportional == 0);
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
    limit.refuted = (std::max)(limit.refuted, limit.certified);
    return limit;
}

}  // namespace taut::proof_detail
