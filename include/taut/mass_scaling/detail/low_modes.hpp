// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "../../proof/pencil_matrix.hpp"
#include "../../tight/dense.hpp"
#include "../../tight/detail/arnoldi.hpp"

namespace taut::proof_detail {

// Templates, though of one type: only their callers compile the eigensolvers and the expressions.

inline constexpr Index dense_low_modes = 600;  // unknowns up to which a dense eigensolver is used

/// Some of the lowest modes of M⁻¹K⁺ above the zero modes, N × r, M-orthonormal: all up to
/// dense_low_modes unknowns, else about twenty.
///
/// Large systems: Krylov vectors of B = K'(K' + σ)⁻², which is 0 on the zero modes, however many
/// mechanisms a net has, and largest on the softest modes above them; modes softer than 1e-7·k_max
/// are among these. One of several modes with the same frequency may stand for all of them.
template <class Real = double>
MatrixX<Real> low_modes(const Pencil& pencil) {
    const Index N = pencil.size();
    if (N == 0) return {};
    const VectorX<Real> root = pencil.mass().cwiseSqrt();
    if (N <= dense_low_modes) {
        const DenseAnalysis<Real> dense(pencil);
        MatrixX<Real> U(N, N);
        Index r = 0;
        for (Index j = 0; j < N; ++j) {
            if (dense.stiffness_eigenvalues()[j] > dense.zero_tolerance())
                U.col(r++) = dense.mode(j);
        }
        return U.leftCols(r);
    }
    constexpr Index steps = 80;
    constexpr Index most = 20;
    constexpr double good = 1e-4;  // residual over value
    const double sigma = 1e-7 * (std::max)(0.0, pencil.upper_bound(matrices::K_plus));
    if (!(sigma > 0)) return {};
    const Eigen::SimplicialLLT<SparseMatrix<Real>> shifted(
        pencil.assemble(matrices::K_plus + sigma * matrices::M));
    if (shifted.info() != Eigen::Success) return {};
    const auto B = [&](const VectorX<Real>& q) {
        VectorX<Real> x = shifted.solve(VectorX<Real>(root.cwiseProduct(q)));
        x = shifted.solve(VectorX<Real>(pencil.mass().cwiseProduct(x)));
        VectorX<Real> y;
        pencil.multiply(matrices::K_plus, x, y);
        return VectorX<Real>(y.cwiseQuotient(root));
    };
    const auto pairs = arnoldi<Real>(B, N, steps);
    std::vector<std::pair<double, Index>> soft;
    for (Index j = 0; j < pairs.value.size(); ++j) {
        const double value = pairs.value[j].real();
        if (value > 0 && pairs.residual[j] <= good * value) soft.emplace_back(-value, j);
    }
    std::sort(soft.begin(), soft.end());
    const Index r = (std::min)(most, static_cast<Index>(soft.size()));
    MatrixX<Real> U(N, r);
    for (Index j = 0; j < r; ++j) {
        U.col(j) = pairs.vector(soft[static_cast<std::size_t>(j)].second).real();
        U.col(j) = U.col(j).normalized().cwiseQuotient(root);
    }
    return U;
}

/// K⁺V.
template <class Real>
MatrixX<Real> stiffness_times(const Pencil& pencil, const MatrixX<Real>& V) {
    MatrixX<Real> KV(V.rows(), V.cols());
    VectorX<Real> y;
    for (Index j = 0; j < V.cols(); ++j) {
        pencil.multiply(matrices::K_plus, V.col(j), y);
        KV.col(j) = y;
    }
    return KV;
}

/// An orthonormal basis of what the columns span.
template <class Real = double>
MatrixX<Real> orthonormal(const MatrixX<Real>& U) {
    Eigen::ColPivHouseholderQR<MatrixX<Real>> qr(U);
    qr.setThreshold(1e-8);
    return qr.householderQ() * MatrixX<Real>::Identity(U.rows(), qr.rank());
}

/// The relative change of up to ten of the lowest frequencies above the zero modes from one pencil
/// to another with the same K and other masses: by Rayleigh and Ritz in the space of the low modes
/// of both, so that a mode missed on one side is found on the other.
template <class Real = double>
std::vector<double> frequency_changes(const Pencil& before, const Pencil& after) {
    const MatrixX<Real> low = low_modes<Real>(before);
    const MatrixX<Real> low_after = low_modes<Real>(after);
    if (low.cols() == 0 || low_after.cols() == 0) return {};
    MatrixX<Real> both(low.rows(), low.cols() + low_after.cols());
    both << low.colwise().normalized(), low_after.colwise().normalized();
    const MatrixX<Real> U = orthonormal<Real>(both);
    const MatrixX<Real> K = U.transpose() * stiffness_times<Real>(before, U);
    const auto eigenvalues = [&](const Pencil& pencil) {
        const MatrixX<Real> M = U.transpose() * pencil.mass().asDiagonal() * U;
        const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixX<Real>> modes(K, M,
                                                                            Eigen::EigenvaluesOnly);
        return VectorX<Real>(modes.eigenvalues());
    };
    const VectorX<Real> k = eigenvalues(before);
    const VectorX<Real> k_after = eigenvalues(after);
    const double zero = 1e-10 * k[k.size() - 1];
    std::vector<double> change;
    for (Index j = 0; j < k.size() && change.size() < 10; ++j) {
        if (k[j] > zero) change.push_back(std::sqrt((std::max)(0.0, k_after[j]) / k[j]) - 1);
    }
    return change;
}

}  // namespace taut::proof_detail
