// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "../../conditions/mode.hpp"
#include "../../proof/detail/growth.hpp"

// What a limit still claims where K or D could not be shown to be positive semi-definite.

namespace taut::proof_detail {

/// The bracket of the largest stable step of implicit Euler. With D ⪰ −δM and K ⪰ −κM, steps are
/// safe while 1 − hδ − h²κ > 0, and the step matrix turns singular where a vector says so [T21].
template <class Real = double>  // a template, as the others below: only its callers compile it
UnroundedLimit implicit_limit(const Pencil& pencil) {
    const double kappa = (std::max)(0.0, pencil.upper_bound(-K_plus));
    if (pencil.projected_semidefinite() || kappa == 0) {
        return {infinity, infinity, Cause::unconditional};
    }
    if (!detail::is_finite(kappa)) return {0, infinity, Cause::overflow};
    const double delta = pencil.damping_semidefinite() ? 0 : pencil.deficit(D);
    const auto definite_up_to = [delta](double most) {
        return critical_step(Method::symplectic_euler, most, delta) / 2;
    };
    const RitzPair softest = largest_ritz_pair(pencil, -K_plus);
    const auto [k, d] = quotients(pencil, softest.vector, K_plus);
    if (k.upper() < 0) {
        return {definite_up_to(kappa),
                critical_step(Method::implicit_euler, k.upper(), (std::max)(0.0, d.upper()))};
    }
    return {definite_up_to(pencil.deficit(K_plus)), infinity};
}

/// Where a matrix is semi-definite only up to `rate`, 1/s, times M, the answer goes to
/// certified_up_to in place of certified: multipliers stay below 1 + h·rate [T17], those of
/// implicit Euler below 1/(1 − h·rate), which is less than e^(2h·rate) while h·rate ≤ ½. Rates add
/// up where they meet in one vector.
inline void admit(Method method, double rate, UnroundedLimit& limit) {
    limit.admitted_growth += is_implicit(method) ? 2 * rate : rate;
    const double most = 1 / (std::max)(limit.admitted_growth, 1e-300);
    limit.certified_up_to = (std::min)((std::max)(limit.certified, limit.certified_up_to), most);
    limit.certified = 0;
    limit.cause = Cause::rounding;
}

/// D ⪰ −δM by rounding is admitted; a δ that is no rounding feeds energy in at every step.
template <class Real = double>
void admit_negative_damping(Method method, const Pencil& pencil, UnroundedLimit& limit) {
    if (pencil.damping_semidefinite()) return;
    const double delta = pencil.deficit(D);
    if (delta == 0) return;
    if (delta <= 1e-6 * (std::max)(0.0, pencil.upper_bound(D))) {
        if (claims(limit)) admit(method, delta, limit);
        return;
    }
    limit.certified = limit.certified_up_to = 0;
    limit.admitted_growth = 0;
    limit.refuted = infinity;
    limit.cause = Cause::damping_unproved;
}

/// What is left of a limit that was found as that of springs.
template <class Real = double>
void amend_for_matrices(Method method, const Pencil& pencil, UnroundedLimit& limit) {
    if (method::is_limited_by<method::LimitedByIndefiniteness>(method))
        limit = implicit_limit(pencil);
    // An explicit step is claimed by D − hK ⪰ −δM, which needs no D ⪰ 0 beside it unless K is
    // indefinite: there it says nothing of smaller steps.
    if (!method::is_limited_by<method::LimitedByDamping>(method) || !claims(limit) ||
        !pencil.stiffness_semidefinite()) {
        admit_negative_damping(method, pencil, limit);
    }
    if (pencil.stiffness_semidefinite() || finds_growth(pencil, limit) || !claims(limit)) return;
    // Not refuted, not proved.
    admit(method, std::sqrt(pencil.deficit(K)), limit);
}

}  // namespace taut::proof_detail
