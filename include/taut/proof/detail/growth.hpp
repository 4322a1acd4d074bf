// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "effort.hpp"

// What the physics adds where K is not known to be positive semi-definite [T27].

namespace taut::proof_detail {

/// Whether a vector shows that the undamped motion grows: its rate is √κ (damping slows the growth
/// but does not remove it).
template <class Real = double>  // a template: only its callers compile the search
bool finds_growth(const Pencil& pencil, UnroundedLimit& limit) {
    LanczosOptions options;
    options.basis = 48;
    options.tolerance = 1e-4;
    const RitzPair softest = largest_ritz_pair(pencil, -K, options);
    const Enclosed k = quotients(pencil, softest.vector, K).k;
    const double resolution = pencil.resolution();
    const double meant =
        resolution > 0 ? resolution * (std::max)(0.0, pencil.upper_bound(K_plus)) : 0;
    if (!(k.upper() < -meant)) return false;
    limit.growth_rate = std::sqrt(-k.value);
    if (limit.certified > 0) limit.cause = Cause::buckling;
    return true;
}

/// Compressed springs: the growth that was found, or what could not be excluded, for then K ⪰ −εM
/// is what can be said.
template <class Effort>
void add_growth(const Pencil& pencil, Effort& effort, UnroundedLimit& limit) {
    if (pencil.stiffness_semidefinite()) return;
    if (finds_growth(pencil, limit) || !claims(limit)) return;
    limit.admitted_growth += std::sqrt(effort.narrow_deficit(pencil, K, pencil.deficit(K)));
}

}  // namespace taut::proof_detail
