// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../stability/detail/symplectic_limit.hpp"
#include "graph_shares.hpp"

namespace taut {

namespace stability_detail {

/// The step that vectors refute where M̃ is that of the step: the least root of
/// uᵀ(4M̃ − 2hD − h²K)u = uᵀ((4 − 2h d0)M − Σ(1 − s/θ)(2hc + h²k)L_e)u. A margin makes springs with
/// s > θ more than implicit: their terms are negative.
/// @param u  to begin with
inline double refuted_inertia(const SpringPencil<1>& pencil, const GraphShares& shares,
                              Eigen::VectorXd u) {
    std::vector<double> over = shares.shares;
    for (double& share : over) share /= shares.margin;
    const SpringPencil<1> rest = pencil.explicit_part(over, 1);
    double refuted = infinity;
    for (int repeat = 0; repeat < 8; ++repeat) {
        const auto [stiffness, damping] = quotients(rest, u, matrices::K);
        const double k = stiffness.lower(), d = damping.lower();
        const double root = std::sqrt(d * d + 4 * k);
        // None where there is no positive root.
        const double h = d >= 0 ? 4 / (d + root) : k > 0 ? (root - d) / k : infinity;
        const double step = h > 0 ? h : infinity;
        if (repeat > 0 && !(step < refuted * (1 - 1e-4))) return std::min(step, refuted);
        refuted = step;
        const Combination next =
            std::isfinite(h) ? 2 * h * matrices::D + h * h * matrices::K : 1 * matrices::K;
        u = largest_ritz_pair(rest, next, {}, u).vector;
    }
    return refuted;
}

}  // namespace stability_detail

/// The step at any pose (linearised) of graph inertia at fixed shares, with the inertia of each
/// step its own [T33]: every h in (0, certified] has (4θ − 2h d0)M − Σ(1 − s)(2h c + h²k)L_e ≻ 0.
/// With dampers larger steps may be stable again; this is the interval from 0. It is never below
/// the step that the shares were made for, and that step's factor serves every shorter one, too.
/// From `refuted` on the step grows where K is L_k ⊗ I, as of springs of no rest length; the margin
/// lies between the two.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> graph_inertia_limit(const SpringSystem<Scalar, Dim, Laws...>& system,
                                      const GraphShares& shares) {
    stability_detail::require_shares_of("graph_inertia_limit", system, shares);
    if (shares.status != Status::ok) {
        return stability_detail::rounded<Scalar>({0, stability_detail::infinity, Cause::overflow},
                                                 system.revision());
    }
    const auto laplacian = SpringPencil<1>::any_pose(system);
    const auto rest = laplacian.explicit_part(shares.shares, shares.margin);
    const auto start = [&](double h) {
        return largest_ritz_pair(rest, 2 * h * matrices::D + h * h * matrices::K_plus).vector;
    };
    stability_detail::Effort effort;
    auto bracket = stability_detail::symplectic_limit(rest, effort, 0, start);
    if (shares.margin < 1 && std::isfinite(bracket.refuted)) {
        bracket.refuted =
            stability_detail::refuted_inertia(laplacian, shares, start(bracket.certified));
    }
    auto limit = stability_detail::rounded<Scalar>(bracket, system.revision());
    // The search for shares may have had better weights.
    limit.certified = std::max(limit.certified, static_cast<Scalar>(shares.step));
    return limit;
}

}  // namespace taut
