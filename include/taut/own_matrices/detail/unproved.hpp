// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "../../method/visit.hpp"
#include "../../stability/detail/effort.hpp"

// What a limit still claims where K or D could not be shown to be positive semi-definite.

namespace taut::stability_detail {

template <class Scalar>
bool claims(const StepLimit<Scalar>& limit) {
    return limit.certified > 0 || limit.certified_up_to > 0;
}

/// Where a matrix is semi-definite only up to `rate`, 1/s, times M, the answer goes to
/// certified_up_to in place of certified: multipliers stay below 1 + h·rate [T17], those of
/// implicit Euler below 1/(1 − h·rate), which is less than e^(2h·rate) while h·rate ≤ ½. Rates add
/// up where they meet in one vector.
template <class Scalar>
void admit(Method method, double rate, StepLimit<Scalar>& limit) {
    limit.admitted_growth += is_implicit(method) ? 2 * rate : rate;
    const double most = 1 / std::max(limit.admitted_growth, 1e-300);
    limit.certified_up_to =
        std::min(std::max(limit.certified, limit.certified_up_to), round_down<Scalar>(most));
    limit.certified = 0;
    limit.cause = Cause::rounding;
}

/// D ⪰ −δM by rounding is admitted; a δ that is no rounding feeds energy in at every step.
template <class Scalar>
void admit_negative_damping(Method method, const Pencil& pencil, StepLimit<Scalar>& limit) {
    if (pencil.damping_semidefinite()) return;
    const double delta = pencil.deficit(D);
    if (delta == 0) return;
    if (delta <= 1e-6 * std::max(0.0, pencil.upper_bound(D))) {
        if (claims(limit)) admit(method, delta, limit);
        return;
    }
    limit.certified = limit.certified_up_to = 0;
    limit.admitted_growth = 0;
    limit.refuted = std::numeric_limits<Scalar>::infinity();
    limit.cause = Cause::damping_unproved;
}

/// What the physics adds where K is not known to be positive semi-definite [T27]: √κ of the
/// undamped motion (damping slows the growth but does not remove it), or what could not be
/// excluded.
template <class Scalar, class Effort>
void add_growth(Method method, const Pencil& pencil, StepLimit<Scalar>& limit,
                [[maybe_unused]] Effort& effort) {
    if (pencil.stiffness_semidefinite()) return;
    LanczosOptions options;
    options.basis = 48;
    options.tolerance = 1e-4;
    const RitzPair softest = largest_ritz_pair(pencil, -K, options);
    const Enclosed k = quotients(pencil, softest.vector, K).k;
    const double resolution = pencil.resolution();
    const double meant =
        resolution > 0 ? resolution * std::max(0.0, pencil.upper_bound(K_plus)) : 0;
    if (k.upper() < -meant) {
        limit.growth_rate = std::sqrt(-k.value);
        if (limit.certified > 0) limit.cause = Cause::buckling;
        return;
    }
    if (!claims(limit)) return;
    // Not refuted, not proved: K ⪰ −εM is what can be said.
    double epsilon = pencil.deficit(K);
    if (!pencil.projected_semidefinite()) return admit(method, std::sqrt(epsilon), limit);
    if constexpr (Effort::factorises) {
        epsilon = std::min(epsilon, proved_deficit(effort.prover, pencil, K, epsilon));
    }
    limit.admitted_growth += std::sqrt(epsilon);
}

}  // namespace taut::stability_detail
