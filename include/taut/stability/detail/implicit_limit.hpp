// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "../../method/mode.hpp"
#include "effort.hpp"

namespace taut::stability_detail {

/// The bracket of the largest stable step of implicit Euler. K⁺ ⪰ 0 is enough for every step to be
/// solvable and stable [T20], [T27]; bare matrices, with D ⪰ −δM and K ⪰ −κM, allow steps while
/// 1 − hδ − h²κ > 0, and the step matrix turns singular where a vector says so [T21].
template <class Real = double>  // a template: only its callers compile the search
UnroundedLimit implicit_limit(const Pencil& pencil) {
    const double kappa = std::max(0.0, pencil.upper_bound(-K_plus));
    if (pencil.projected_semidefinite() || kappa == 0) {
        return {infinity, infinity, Cause::unconditional};
    }
    if (!std::isfinite(kappa)) return {0, infinity, Cause::overflow};
    const double delta = pencil.damping_semidefinite() ? 0 : pencil.deficit(D);
    const auto definite_up_to = [delta](double most) {
        return critical_step(Method::symplectic_euler, most, delta) / 2;
    };
    const RitzPair softest = largest_ritz_pair(pencil, -K_plus);
    const auto [k, d] = quotients(pencil, softest.vector, K_plus);
    if (k.upper() < 0) {
        return {definite_up_to(kappa),
                critical_step(Method::implicit_euler, k.upper(), std::max(0.0, d.upper()))};
    }
    return {definite_up_to(pencil.deficit(K_plus)), infinity};
}

/// The same of graph inertia, whose masses grow by D without d0·M and by K⁺: 4θM̃ − 2hD − h²K⁺ =
/// (4θ − 2h d0)M [T33].
/// @param margin  θ
template <class Real = double>
UnroundedLimit drag_limit(const Pencil& pencil, double margin) {
    UnroundedLimit limit = implicit_limit<Real>(pencil);
    const double drag = pencil.rayleigh().mass_proportional;
    if (!(2 * margin / drag < limit.certified)) return limit;
    limit.certified = 2 * margin / drag;
    limit.cause = Cause::damping;
    return limit;
}

}  // namespace taut::stability_detail
