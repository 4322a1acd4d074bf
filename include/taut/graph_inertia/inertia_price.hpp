// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <vector>

#include "../mass_scaling/detail/low_modes.hpp"
#include "graph_shares.hpp"

namespace taut {
namespace stability_detail {

/// M̃ − M of the free degrees of freedom, kg.
template <class System>
SparseMatrix<double> added_inertia(const System& system, const GraphShares& shares) {
    constexpr int Dim = System::Dim;
    require_shares_of("inertia_price", system, shares);
    const FreeParticles free(system);
    std::vector<Eigen::Triplet<double>> entries;
    for_each_inertia(system, shares, [&](Index a, Index b, double damped, double elastic) {
        const auto row = [&](Index particle, int d) {
            const Index i = free.place(particle);
            return static_cast<int>(i < 0 ? i : Dim * i + d);
        };
        for (int d = 0; d < Dim; ++d)
            add_laplacian(row(a, d), row(b, d), damped + elastic, entries);
    });
    SparseMatrix<double> added(Dim * free.count(), Dim * free.count());
    added.setFromTriplets(entries.begin(), entries.end());
    return added;
}

}  // namespace stability_detail

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
        return of(SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>()),
                  most);
    }
    /// The same of the pencil at that pose.
    static LowModes of(const Pencil& pencil, Index most = std::numeric_limits<Index>::max()) {
        LowModes modes;
        modes.shapes = stability_detail::low_modes(pencil);
        modes.all = pencil.size() <= stability_detail::dense_low_modes;
        if (modes.shapes.cols() > most) {
            modes.shapes = modes.shapes.leftCols(most).eval();
            modes.all = false;
        }
        modes.project(pencil);
        modes.frequency = modes.frequencies(modes.mass);
        return modes;
    }
    /// Brings stiffness and mass up to date with the shapes.
    void project(const Pencil& pencil) {
        stiffness = shapes.transpose() * stability_detail::stiffness_times<double>(pencil, shapes);
        mass = shapes.transpose() * pencil.mass().asDiagonal() * shapes;
    }
    /// ω of other masses, UᵀM̃U, rad/s, ascending.
    Eigen::VectorXd frequencies(const Eigen::MatrixXd& masses) const {
        if (masses.rows() == 0) return {};
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
            stiffness, masses, Eigen::EigenvaluesOnly);
        return solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    }
};

namespace stability_detail {

/// @param added  M̃ − M of the free degrees of freedom, kg
template <class System>
InertiaPrice price_of(const System& system, const SparseMatrix<double>& added,
                      const LowModes& modes, Index count) {
    InertiaPrice price;
    double mass = 0;
    for (const Index i : FreeParticles(system)) mass += static_cast<double>(system.mass(i));
    if (mass > 0) price.added = added.diagonal().sum() / (System::Dim * mass);
    if (count <= 0 || modes.frequency.size() == 0) return price;
    const Eigen::VectorXd slowed =
        modes.frequencies(modes.mass + modes.shapes.transpose() * (added * modes.shapes));
    for (Index j = 0; j < std::min<Index>(count, slowed.size()); ++j)
        price.modes.push_back({modes.frequency[j], slowed[j]});
    return price;
}

}  // namespace stability_detail

/// The price of shares at their step: the added inertia as a share of the mass, and what it makes
/// of the lowest frequencies: ω̃/ω = (1 + q)^−½, q = uᵀ(M̃ − M)u/uᵀMu, all low modes by Rayleigh and
/// Ritz. Numerical, no proof. It does not count what the step itself does, an h²ω²/24, nor that a
/// mode may give way along mechanisms: where there are any, the slowing is less than it says.
/// Fails unless the shares are of the system as it is.
/// @param modes  LowModes::of the system at a pose
/// @param count  modes asked for; fewer where there are fewer
template <class System>
InertiaPrice inertia_price(const System& system, const GraphShares& shares, const LowModes& modes,
                           Index count) {
    return stability_detail::price_of(system, stability_detail::added_inertia(system, shares),
                                      modes, count);
}

/// The same at the pose of a state, whose modes are found first, mechanisms counted: one more
/// factorisation.
template <class Scalar, int Dim, class... Laws>
InertiaPrice inertia_price(const SpringSystem<Scalar, Dim, Laws...>& system,
                           const State<Scalar, Dim>& state, const GraphShares& shares,
                           Index count) {
    const auto added = stability_detail::added_inertia(system, shares);
    if (count <= 0) return stability_detail::price_of(system, added, {}, 0);
    const auto pencil =
        SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>());
    LowModes modes = LowModes::of(pencil);
    if (modes.frequency.size() > 0) {
        // Modes are orthogonal to mechanisms, by M before and by M̃ after: (K⁺ + σM̃)⁻¹K⁺u is.
        const double sigma = 1e-7 * std::max(0.0, pencil.upper_bound(matrices::K_plus));
        const SparseMatrix<double> heavier = pencil.assemble(1 * matrices::M) + added;
        const Eigen::SimplicialLLT<SparseMatrix<double>> shifted(
            pencil.assemble(1 * matrices::K_plus) + sigma * heavier);
        if (shifted.info() == Eigen::Success) {
            modes.shapes =
                shifted.solve(stability_detail::stiffness_times<double>(pencil, modes.shapes))
                    .eval();
            modes.project(pencil);
        }
    }
    return stability_detail::price_of(system, added, modes, count);
}

}  // namespace taut
