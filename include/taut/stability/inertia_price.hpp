// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <vector>

#include "detail/low_modes.hpp"
#include "graph_shares.hpp"

namespace taut {
namespace stability_detail {

/// K⁺V.
inline Eigen::MatrixXd stiffness_times(const Pencil& pencil, const Eigen::MatrixXd& V) {
    Eigen::MatrixXd KV(V.rows(), V.cols());
    Eigen::VectorXd y;
    for (Index j = 0; j < V.cols(); ++j) {
        pencil.multiply(matrices::K_plus, V.col(j), y);
        KV.col(j) = y;
    }
    return KV;
}

/// M̃ − M of the free degrees of freedom, kg.
template <class System>
SparseMatrix<double> added_inertia(const System& system, const GraphShares& shares) {
    if (shares.revision != system.revision() ||
        static_cast<Index>(shares.shares.size()) != system.spring_count())
        fail("inertia_price: the shares are of another revision of the system");
    constexpr int Dim = System::Dim;
    const FreeParticles free(system);
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](Index i, Index j, double inertia) {
        for (int d = 0; d < Dim; ++d) entries.emplace_back(Dim * i + d, Dim * j + d, inertia);
    };
    for_each_inertia(system, shares, [&](Index a, Index b, double damped, double elastic) {
        const Index i = free.place(a);
        const Index j = free.place(b);
        for (const Index row : {i, j}) {
            if (row >= 0) add(row, row, damped + elastic);
        }
        if (i < 0 || j < 0) return;
        add(i, j, -damped - elastic);
        add(j, i, -damped - elastic);
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
        const auto pencil =
            SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>());
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
        stiffness = shapes.transpose() * stability_detail::stiffness_times(pencil, shapes);
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
    const auto added = stability_detail::added_inertia(system, shares);
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

/// The same at the pose of a state, whose modes are found first, mechanisms counted: one more
/// factorisation.
template <class Scalar, int Dim, class... Laws>
InertiaPrice inertia_price(const SpringSystem<Scalar, Dim, Laws...>& system,
                           const State<Scalar, Dim>& state, const GraphShares& shares,
                           Index count) {
    if (count <= 0) return inertia_price(system, shares, LowModes{}, 0);
    LowModes modes = LowModes::of(system, state);
    if (modes.frequency.size() == 0) return inertia_price(system, shares, modes, count);
    const auto pencil =
        SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>());
    // Modes are orthogonal to mechanisms, by M before and by M̃ after: (K⁺ + σM̃)⁻¹K⁺u is.
    const double sigma = 1e-7 * std::max(0.0, pencil.upper_bound(matrices::K_plus));
    const SparseMatrix<double> heavier =
        pencil.assemble(1 * matrices::M) + stability_detail::added_inertia(system, shares);
    const Eigen::SimplicialLLT<SparseMatrix<double>> shifted(pencil.assemble(1 * matrices::K_plus) +
                                                             sigma * heavier);
    if (shifted.info() != Eigen::Success) return inertia_price(system, shares, modes, count);
    modes.shapes = shifted.solve(stability_detail::stiffness_times(pencil, modes.shapes)).eval();
    modes.project(pencil);
    return inertia_price(system, shares, modes, count);
}

}  // namespace taut
