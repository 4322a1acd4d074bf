// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "detail/low_modes.hpp"
#include "graph_shares.hpp"

namespace taut {

/// The step at any pose (linearised) of graph inertia at fixed shares, with the inertia of each
/// step its own [T33]: every h in (0, certified] has (4θ − 2h d0)M − Σ(1 − s)(2h c + h²k)L_e ≻ 0.
/// With dampers larger steps may be stable again; this is the interval from 0. It is never below
/// the step that the shares were made for, and that step's factor serves every shorter one, too.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> graph_inertia_limit(const SpringSystem<Scalar, Dim, Laws...>& system,
                                      const GraphShares& shares) {
    if (shares.revision != system.revision())
        fail("graph_inertia_limit: the shares are of another revision of the system");
    if (shares.status != Status::ok) {
        return stability_detail::rounded<Scalar>({0, stability_detail::infinity, Cause::overflow},
                                                 system.revision());
    }
    const auto rest = SpringPencil<1>::any_pose(system).explicit_part(shares.shares, shares.margin);
    const auto start = [&](double h) {
        return stability_detail::leading_pair(rest, 2 * h * matrices::D + h * h * matrices::K_plus)
            .vector;
    };
    stability_detail::Bounds effort;
    auto limit = stability_detail::rounded<Scalar>(
        stability_detail::symplectic_limit(rest, effort, 0, start), system.revision());
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

/// The low modes of a scene at a pose, which inertia_price asks for: the same for all shares.
struct LowModes {
    Eigen::MatrixXd shapes;     ///< U, N × r, M-orthonormal but for rounding
    Eigen::MatrixXd stiffness;  ///< UᵀK⁺U
    Eigen::MatrixXd mass;       ///< UᵀMU
    Eigen::VectorXd frequency;  ///< ω by Rayleigh and Ritz, rad/s, ascending
    bool all = false;           ///< no mode above the zero modes is left out

    /// The lowest modes above the zero modes; r ≤ `most`.
    template <class Scalar, int Dim, class... Laws>
    static LowModes of(const SpringSystem<Scalar, Dim, Laws...>& system,
                       const State<Scalar, Dim>& state,
                       Index most = std::numeric_limits<Index>::max()) {
        const auto pencil =
            SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>());
        LowModes modes;
        modes.shapes = stability_detail::low_modes(pencil);
        modes.all = pencil.size() <= stability_detail::dense_low_modes;
        if (modes.shapes.cols() > most) {
            modes.shapes = modes.shapes.leftCols(most).eval();
            modes.all = false;
        }
        const Eigen::MatrixXd& U = modes.shapes;
        Eigen::MatrixXd KU(U.rows(), U.cols());
        Eigen::VectorXd y;
        for (Index j = 0; j < U.cols(); ++j) {
            pencil.multiply(matrices::K_plus, U.col(j), y);
            KU.col(j) = y;
        }
        modes.stiffness = U.transpose() * KU;
        modes.mass = U.transpose() * pencil.mass().asDiagonal() * U;
        modes.frequency = modes.frequencies(modes.mass);
        return modes;
    }
    /// ω of other masses, UᵀM̃U, rad/s, ascending.
    Eigen::VectorXd frequencies(const Eigen::MatrixXd& masses) const {
        if (masses.rows() == 0) return {};
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
            stiffness, masses, Eigen::EigenvaluesOnly);
        return solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    }
};

/// The price of shares at their step: the added inertia as a share of the mass, and what it makes
/// of the lowest frequencies at a pose: ω̃/ω = (1 + q)^−½, q = uᵀ(M̃ − M)u/uᵀMu, near-equal modes by
/// Rayleigh and Ritz. Numerical, no proof. It does not count what the step itself does, an h²ω²/24.
/// @param modes  LowModes::of the system at that pose
/// @param count  modes asked for; fewer where there are fewer
template <class Scalar, int Dim, class... Laws>
InertiaPrice inertia_price(const SpringSystem<Scalar, Dim, Laws...>& system,
                           const GraphShares& shares, const LowModes& modes, Index count) {
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
    if (count <= 0 || modes.frequency.size() == 0) return price;
    SparseMatrix<double> added(free.count(), free.count());
    added.setFromTriplets(entries.begin(), entries.end());
    Eigen::MatrixXd heavier = modes.mass;
    for (int d = 0; d < Dim; ++d) {
        const Eigen::MatrixXd axis = modes.shapes(Eigen::seqN(d, free.count(), Dim), Eigen::all);
        heavier += axis.transpose() * (added * axis);
    }
    const Eigen::VectorXd slowed = modes.frequencies(heavier);
    for (Index j = 0; j < std::min<Index>(count, slowed.size()); ++j)
        price.modes.push_back({modes.frequency[j], slowed[j]});
    return price;
}

/// The same at the pose of a state, whose modes are found first.
template <class Scalar, int Dim, class... Laws>
InertiaPrice inertia_price(const SpringSystem<Scalar, Dim, Laws...>& system,
                           const State<Scalar, Dim>& state, const GraphShares& shares,
                           Index count) {
    const LowModes modes = count > 0 ? LowModes::of(system, state) : LowModes{};
    return inertia_price(system, shares, modes, count);
}

}  // namespace taut
