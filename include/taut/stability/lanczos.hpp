// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "pencil.hpp"

namespace taut {

struct LanczosOptions {
    int steps = 24;           ///< of one run: the memory is steps × N doubles
    int restarts = 4;         ///< more runs, each from the last Ritz vector
    double tolerance = 1e-3;  ///< stop when residual ≤ tolerance·|value|
};

/// An approximate eigenpair of M⁻¹S.
struct RitzPair {
    double value = 0;         ///< 1/s² for K, 1/s for D; never above the largest eigenvalue
    double residual = 0;      ///< ‖M⁻½(S − value·M)u‖ for the vector of unit M-norm
    Eigen::VectorXd vector;   ///< u, N, with uᵀM u = 1
    int products = 0;         ///< multiplications by S spent
};

namespace detail {

/// A fixed pseudo-random vector: the same on every machine, with a component along every mode.
inline Eigen::VectorXd scattered_vector(Index N) {
    Eigen::VectorXd q(N);
    std::uint64_t word = 0x9e3779b97f4a7c15u;
    for (Index i = 0; i < N; ++i) {
        word ^= word << 13;
        word ^= word >> 7;
        word ^= word << 17;
        q[i] = static_cast<double>(word >> 11) * 0x1p-53 - 0.5;
    }
    return q;
}

}  // namespace detail

/// The largest eigenvalue of M⁻¹S by Lanczos with full reorthogonalisation, from below.
/// Negate the factors of `c` for the smallest one.
/// @param start  an approximate eigenvector to begin with, N; empty: a fixed scattered vector
inline RitzPair largest_ritz_pair(const Pencil& pencil, const Combination& c,
                                  const LanczosOptions& options = {},
                                  const Eigen::VectorXd& start = {}) {
    const Index N = pencil.size();
    const Eigen::VectorXd root = pencil.mass().cwiseSqrt();
    const Index m = std::min<Index>(options.steps, N);
    Eigen::MatrixXd Q(N, m);
    Eigen::VectorXd diagonal(m);
    Eigen::VectorXd off(m);
    Eigen::VectorXd w(N);
    RitzPair pair;
    Eigen::VectorXd q = start.size() == N ? Eigen::VectorXd(root.cwiseProduct(start))
                                          : detail::scattered_vector(N);
    for (int run = 0; run <= options.restarts; ++run) {
        q.normalize();
        Index used = 0;
        double beta = 0;
        while (used < m) {
            const Index j = used++;
            Q.col(j) = q;
            pencil.multiply(c, q.cwiseQuotient(root), w);
            ++pair.products;
            w.array() /= root.array();
            diagonal[j] = q.dot(w);
            // Twice is enough (Parlett): the basis stays orthogonal to rounding.
            for (int pass = 0; pass < 2; ++pass) {
                w.noalias() -= Q.leftCols(used) * (Q.leftCols(used).transpose() * w).eval();
            }
            beta = w.norm();
            off[j] = beta;
            const double scale = std::abs(diagonal[j]) + (j > 0 ? off[j - 1] : 0);
            if (!(beta > 1e-14 * scale)) break;  // an invariant subspace: the Ritz values are exact
            q = w / beta;
        }
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> tridiagonal;
        tridiagonal.computeFromTridiagonal(diagonal.head(used), off.head(used - 1));
        const Eigen::VectorXd s = tridiagonal.eigenvectors().col(used - 1);
        pair.value = tridiagonal.eigenvalues()[used - 1];
        pair.residual = beta * std::abs(s[used - 1]);
        q = Q.leftCols(used) * s;
        if (pair.residual <= options.tolerance * std::abs(pair.value)) break;
    }
    q.normalize();
    pair.vector = q.cwiseQuotient(root);
    return pair;
}

}  // namespace taut
