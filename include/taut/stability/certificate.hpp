// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <cmath>
#include <limits>
#include <vector>

#include "../core/types.hpp"

namespace taut {

/// Outcome of proves_positive_definite.
struct DefinitenessProof {
    bool proved = false;
    double shift = 0;  ///< subtracted from the unit diagonal to pay for all rounding, relative
};

namespace detail {

/// Most nonzeros in a row of L, the diagonal counted.
inline Index widest_row(const Eigen::SparseMatrix<double>& L) {
    std::vector<Index> count(static_cast<std::size_t>(L.rows()), 0);
    for (Index j = 0; j < L.outerSize(); ++j) {
        for (Eigen::SparseMatrix<double>::InnerIterator entry(L, j); entry; ++entry) {
            ++count[entry.row()];
        }
    }
    return *std::max_element(count.begin(), count.end());
}

/// γ/(1 − γ) with γ = (q + 1)u/(1 − (q + 1)u), rounded up [T22].
inline double cholesky_rounding(Index q) {
    const double u = std::numeric_limits<double>::epsilon() / 2;
    const double gamma = static_cast<double>(q + 2) * u;  // one more for this line's own rounding
    return gamma / (1 - 2 * gamma);
}

}  // namespace detail

/// Proves that a symmetric matrix is positive definite, rounding included: a floating-point Cholesky
/// factorisation of A − cI that runs to completion, with c above all that rounding can hide
/// (S. M. Rump, Verification of positive definiteness, BIT 2006) [T22].
///
/// A is first scaled to a diagonal near one by powers of two, which is exact and keeps definiteness.
/// @param A      symmetric, both triangles stored
/// @param error  N: bounds on the absolute row sums of the errors with which A was formed
/// @returns proved, or not proved: never a disproof.
inline DefinitenessProof proves_positive_definite(const Eigen::SparseMatrix<double>& A,
                                                  const Eigen::VectorXd& error) {
    DefinitenessProof proof;
    const Index N = A.rows();
    Eigen::VectorXd scale(N);
    double slack = 0;
    for (Index i = 0; i < N; ++i) {
        const double a = A.coeff(i, i);
        if (!(a > error[i]) || !std::isfinite(a)) return proof;
        scale[i] = std::exp2(-std::round(std::log2(a) / 2));
    }
    Eigen::SparseMatrix<double> S = scale.asDiagonal() * A * scale.asDiagonal();
    // Gershgorin for the errors, in the scaled matrix: |s_i E_ij s_j| ≤ (s_i² + s_j²)/2 · |E_ij|.
    const double spread = scale.maxCoeff();
    for (Index i = 0; i < N; ++i) slack = std::max(slack, scale[i] * error[i] * spread);
    const double trace = S.diagonal().sum() * (1 + 1e-10);

    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> llt;
    llt.analyzePattern(S);
    Index assumed = std::min<Index>(N, 256);
    for (int attempt = 0; attempt < 2; ++attempt) {
        const double u = std::numeric_limits<double>::epsilon();
        proof.shift = (slack + detail::cholesky_rounding(assumed) * trace) * (1 + 1e-10) + 4 * u;
        Eigen::SparseMatrix<double> shifted = S;
        shifted.diagonal().array() -= proof.shift;
        llt.factorize(shifted);
        if (llt.info() != Eigen::Success) return proof;
        const Index q = detail::widest_row(llt.matrixL().nestedExpression());
        if (q <= assumed) {
            proof.proved = true;
            return proof;
        }
        assumed = q;
    }
    return proof;
}

}  // namespace taut
