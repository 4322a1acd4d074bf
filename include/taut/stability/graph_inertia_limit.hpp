// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "detail/low_modes.hpp"
#include "graph_shares.hpp"

namespace taut {

namespace stability_detail {

/// The smallest step found at which 4M̃ − 2hD − h²L_k, the true one without margin, is not ≻ 0:
/// there a multiplier is ≤ −1. Of it springs have the part 1 − s/θ, of either sign.
/// @param all   the scene's pencil at any pose   @param h  s, to begin with
/// @param u     N, to begin with
inline double refuted_graph_inertia(const SpringPencil<1>& all, const GraphShares& shares, double h,
                                    Eigen::VectorXd u) {
    std::vector<double> over = shares.shares;
    for (double& share : over) share /= shares.margin;
    const auto edge = all.explicit_part(over, 1);
    double refuted = infinity;
    for (int repeat = 0; repeat < 8; ++repeat) {
        u = largest_ritz_pair(edge, 2 * h * D + h * h * matrices::K, {}, u).vector;
        const double m = all.quadratic(M, u).upper();
        // |1 − s/θ| ≤ 1/θ: rounding errors are at most those of all springs, over θ.
        const auto least = [&](const Combination& c) {
            return (edge.quadratic(c, u).value - all.quadratic(c, u).error / shares.margin) / m;
        };
        const double k = least(matrices::K);
        const double d = least(D);
        const double inside = d * d + 4 * k;
        const double sum = inside >= 0 ? d + std::sqrt(inside) : 0;
        const double smaller = sum > 0 ? 4 / sum : infinity;
        if (!(smaller < refuted)) break;
        const bool last = smaller > refuted * (1 - 1e-4);
        refuted = h = smaller;
        if (last) break;
    }
    return refuted;
}

}  // namespace stability_detail

/// The step at any pose (linearised) of graph inertia at fixed shares, with the inertia of each
/// step its own [T33]: every h in (0, certified] has (4θ − 2h d0)M − Σ(1 − s)(2h c + h²k)L_e ≻ 0.
/// With dampers larger steps may be stable again; this is the interval from 0. It is never below
/// the step that the shares were made for, and that step's factor serves every shorter one, too.
/// What is refuted is the step as it is, without the margin: there a multiplier is ≤ −1, so at
/// θ = 0.83 certified and refuted are 9 % apart where nothing is damped or implicit.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> graph_inertia_limit(const SpringSystem<Scalar, Dim, Laws...>& system,
                                      const GraphShares& shares) {
    if (shares.revision != system.revision())
        fail("graph_inertia_limit: the shares are of another revision of the system");
    if (shares.status != Status::ok) {
        return stability_detail::rounded<Scalar>({0, stability_detail::infinity, Cause::overflow},
                                                 system.revision());
    }
    const auto all = SpringPencil<1>::any_pose(system);
    const auto rest = all.explicit_part(shares.shares, shares.margin);
    const auto start = [&](double h) {
        return stability_detail::leading_pair(rest, 2 * h * matrices::D + h * h * matrices::K_plus)
            .vector;
    };
    stability_detail::Bounds effort;
    auto found = stability_detail::symplectic_limit(rest, effort, 0, start);
    if (found.refuted < stability_detail::infinity) {
        found.refuted = stability_detail::refuted_graph_inertia(all, shares, found.certified,
                                                                start(found.certified));
    }
    auto limit = stability_detail::rounded<Scalar>(found, system.revision());
    // The search for shares may have had better weights.
    limit.certified = std::max(limit.certified, static_cast<Scalar>(shares.step));
    return limit;
}

/// One mode of vibration without added inertia and with it, rad/s.
struct SlowedMode {
    double frequency = 0;         ///< ω
    double slowed_frequency = 0;  ///< ω̃

    /// ω̃/ω − 1, ≤ 0.
    double change() const { return slowed_frequency / frequency - 1; }
};

/// What graph inertia costs in accuracy.
struct InertiaPrice {
    double added = 0;  ///< trace of M̃ − M over that of M, both of the free particles
    std::vector<SlowedMode> modes;  ///< the lowest above the zero modes, ascending
};

/// The price of shares at their step: the added inertia as a share of the mass, and what it makes
/// of the lowest frequencies at a pose: ω̃/ω = (1 + q)^−½, q = uᵀ(M̃ − M)u/uᵀMu, near-equal modes by
/// Rayleigh and Ritz. Numerical, no proof. It does not count what the step itself does, an h²ω²/24.
/// @param count  modes asked for; fewer where the scene has fewer
template <class Scalar, int Dim, class... Laws>
InertiaPrice inertia_price(const SpringSystem<Scalar, Dim, Laws...>& system,
                           const State<Scalar, Dim>& state, const GraphShares& shares,
                           Index count) {
    const FreeParticles free(system);
    std::vector<Eigen::Triplet<double>> entries;  // of M̃ − M, a row a free particle
    InertiaPrice price;
    double mass = 0;
    for (const Index i : free) mass += static_cast<double>(system.mass(i));
    for_each_inertia(system, shares, [&](Index a, Index b, double damped, double elastic) {
        const double inertia = damped + elastic;
        const Index i = free.place(a);
        const Index j = free.place(b);
        for (const Index row : {i, j}) {
            if (row < 0) continue;
            entries.emplace_back(row, row, inertia);
            price.added += inertia / mass;
        }
        if (i < 0 || j < 0) return;
        entries.emplace_back(i, j, -inertia);
        entries.emplace_back(j, i, -inertia);
    });
    if (count <= 0 || free.count() == 0) return price;
    SparseMatrix<double> added(free.count(), free.count());
    added.setFromTriplets(entries.begin(), entries.end());
    const auto pencil =
        SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>());
    const Eigen::MatrixXd U = stability_detail::low_modes(pencil);
    Eigen::MatrixXd KU(U.rows(), U.cols());
    Eigen::VectorXd y;
    for (Index j = 0; j < U.cols(); ++j) {
        pencil.multiply(matrices::K_plus, U.col(j), y);
        KU.col(j) = y;
    }
    const Eigen::MatrixXd K = U.transpose() * KU;
    const Eigen::MatrixXd M = U.transpose() * pencil.mass().asDiagonal() * U;
    Eigen::MatrixXd heavier = M;
    for (int d = 0; d < Dim; ++d) {
        const Eigen::MatrixXd axis = U(Eigen::seqN(d, free.count(), Dim), Eigen::all);
        heavier += axis.transpose() * (added * axis);
    }
    using Solver = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>;
    const Solver before(K, M, Eigen::EigenvaluesOnly);
    const Solver after(K, heavier, Eigen::EigenvaluesOnly);
    for (Index j = 0; j < std::min<Index>(count, U.cols()); ++j) {
        price.modes.push_back({std::sqrt(std::max(0.0, before.eigenvalues()[j])),
                               std::sqrt(std::max(0.0, after.eigenvalues()[j]))});
    }
    return price;
}

}  // namespace taut
