// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "detail/low_modes.hpp"
#include "detail/symplectic_limit.hpp"
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
    if (shares.revision != system.revision())
        fail("graph_inertia_limit: the shares are of another revision of the system");
    if (shares.status != Status::ok) {
        return stability_detail::rounded<Scalar>({0, stability_detail::infinity, Cause::overflow},
                                                 system.revision());
    }
    const auto laplacian = SpringPencil<1>::any_pose(system);
    const auto rest = laplacian.explicit_part(shares.shares, shares.margin);
    const auto start = [&](double h) {
        return stability_detail::leading_pair(rest, 2 * h * matrices::D + h * h * matrices::K_plus)
            .vector;
    };
    stability_detail::Bounds effort;
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
/// of the lowest frequencies at a pose: ω̃/ω = (1 + q)^−½, q = uᵀ(M̃ − M)u/uᵀMu, all low modes by
/// Rayleigh and Ritz, free of mechanisms. Numerical, no proof. It does not count what the step
/// itself does, an h²ω²/24.
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
    const auto pencil =
        SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>());
    const Eigen::MatrixXd U = stability_detail::low_modes(pencil);
    if (U.cols() == 0) return price;
    std::vector<Eigen::Triplet<double>> along_axes;
    for (const auto& entry : entries) {
        for (int d = 0; d < Dim; ++d) {
            along_axes.emplace_back(Dim * entry.row() + d, Dim * entry.col() + d, entry.value());
        }
    }
    SparseMatrix<double> heavy(pencil.size(), pencil.size());  // M̃ ⊗ I
    heavy.setFromTriplets(along_axes.begin(), along_axes.end());
    heavy += pencil.assemble(1 * matrices::M);
    // Modes are orthogonal to mechanisms, by M before and by M̃ after: (K⁺ + σM̃)⁻¹K⁺u is.
    const double sigma = 1e-7 * std::max(0.0, pencil.upper_bound(matrices::K_plus));
    const Eigen::SimplicialLLT<SparseMatrix<double>> shifted(pencil.assemble(1 * matrices::K_plus) +
                                                             sigma * heavy);
    if (shifted.info() != Eigen::Success) return price;
    const auto times_K = [&](const Eigen::MatrixXd& V) {
        Eigen::MatrixXd KV(V.rows(), V.cols());
        Eigen::VectorXd y;
        for (Index j = 0; j < V.cols(); ++j) {
            pencil.multiply(matrices::K_plus, V.col(j), y);
            KV.col(j) = y;
        }
        return KV;
    };
    const Eigen::MatrixXd KU = times_K(U);
    const Eigen::MatrixXd V = shifted.solve(KU);
    using Solver = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>;
    const Solver before(U.transpose() * KU, U.transpose() * pencil.mass().asDiagonal() * U,
                        Eigen::EigenvaluesOnly);
    const Solver after(V.transpose() * times_K(V), V.transpose() * (heavy * V),
                       Eigen::EigenvaluesOnly);
    for (Index j = 0; j < std::min<Index>(count, U.cols()); ++j) {
        price.modes.push_back({std::sqrt(std::max(0.0, before.eigenvalues()[j])),
                               std::sqrt(std::max(0.0, after.eigenvalues()[j]))});
    }
    return price;
}

}  // namespace taut
