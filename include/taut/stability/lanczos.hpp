// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pencil.hpp"

namespace taut {

/// What a search for a Ritz pair may cost.
struct LanczosOptions {
    int basis = 16;           ///< vectors kept at most: the memory is basis × N doubles
    int restarts = 8;         ///< at most; each keeps the best third of the basis
    double tolerance = 2e-2;  ///< stop when residual ≤ tolerance·|value| …
    double settled = 0;       ///< … or when a restart raised the value by less than this share
};

/// An approximate eigenpair of M⁻¹S.
struct RitzPair {
    double value = 0;        ///< 1/s² for K, 1/s for D; never above the largest eigenvalue
    double residual = 0;     ///< ‖M⁻½(S − value·M)u‖ for the vector of unit M-norm
    Eigen::VectorXd vector;  ///< u, N, with uᵀM u = 1
    int products = 0;        ///< multiplications by S spent
};

namespace detail {

/// A fixed pseudo-random vector: the same on every machine, with a component along every mode.
inline Eigen::VectorXd scattered_vector(Index N, Index seed = 0) {
    Eigen::VectorXd q(N);
    std::uint64_t word = 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(seed);
    for (Index i = 0; i < N; ++i) {
        word ^= word << 13;
        word ^= word >> 7;
        word ^= word << 17;
        q[i] = static_cast<double>(word >> 11) * 0x1p-53 - 0.5;
    }
    return q;
}

/// Eigenvalues, ascending, and eigenvectors of a small symmetric matrix.
struct SmallSpectrum {
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;
};

/// Householder's reduction, column by column, and Eigen's QR iteration: Eigen's own reduction is
/// blocked, and compiling that takes longer than everything else that max_step needs.
template <class Real = double>  // a template: only its callers compile the eigensolver
SmallSpectrum small_spectrum(Eigen::MatrixXd A) {
    const Index m = A.rows();
    double scale = A.cwiseAbs().maxCoeff();
    if (!(scale > 0)) scale = 1;
    A /= scale;
    Eigen::MatrixXd V = Eigen::MatrixXd::Identity(m, m);
    Eigen::VectorXd v(m);
    Eigen::VectorXd w(m);
    for (Index k = 0; k + 2 < m; ++k) {
        v = A.col(k);
        v.head(k + 1).setZero();
        const double norm = v.norm();
        if (!(norm > 1e-150)) continue;  // its squares would lose digits, and it changes nothing
        v[k + 1] += v[k + 1] < 0 ? -norm : norm;
        v.normalize();
        // (I − 2vvᵀ)A(I − 2vvᵀ) = A − vwᵀ − wvᵀ.
        w.noalias() = A * v;
        w = 2 * (w - v.dot(w) * v);
        for (Index j = 0; j < m; ++j) A.col(j) -= w[j] * v + v[j] * w;
        w.noalias() = V * v;
        for (Index j = 0; j < m; ++j) V.col(j) -= 2 * v[j] * w;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> tridiagonal;
    const Eigen::VectorXd beside = A.diagonal<-1>();
    tridiagonal.computeFromTridiagonal(A.diagonal(), beside);
    SmallSpectrum spectrum{scale * tridiagonal.eigenvalues(), std::move(A)};
    for (Index j = 0; j < m; ++j) {
        spectrum.vectors.col(j).noalias() = V * tridiagonal.eigenvectors().col(j);
    }
    return spectrum;
}

}  // namespace detail

/// The largest eigenvalue of M⁻¹S from below: Lanczos with full reorthogonalisation and thick
/// restart (K. Wu and H. Simon, Thick-restart Lanczos method for large symmetric eigenvalue
/// problems, 2000). Negate the factors of `c` for the smallest one.
/// @param start  an approximate eigenvector to begin with, N; empty: a fixed scattered vector
template <class Real = double>  // a template: only its callers compile the eigensolver
RitzPair largest_ritz_pair(const Pencil& pencil, const Combination& c,
                           const LanczosOptions& options = {}, const Eigen::VectorXd& start = {}) {
    const Index N = pencil.size();
    const Index m = std::min<Index>(options.basis, N);
    const Eigen::VectorXd root = pencil.mass().cwiseSqrt();
    Eigen::MatrixXd Q(N, m);                          // orthonormal basis
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, m);  // QᵀAQ with A = M⁻½SM⁻½
    Eigen::MatrixXd best;                             // what a restart keeps
    Eigen::VectorXd w(N);
    Eigen::VectorXd h(m);
    Eigen::VectorXd q =
        start.size() == N ? Eigen::VectorXd(root.cwiseProduct(start)) : detail::scattered_vector(N);
    q.normalize();
    RitzPair pair;
    Index kept = 0;
    for (int run = 0; run <= options.restarts; ++run) {
        Index used = kept;
        double beta = 0;
        while (used < m) {
            const Index j = used++;
            Q.col(j) = q;
            pencil.multiply(c, q.cwiseQuotient(root), w);
            ++pair.products;
            w.array() /= root.array();
            h.head(used).noalias() = Q.leftCols(used).transpose() * w;
            H.col(j).head(used) = h.head(used);
            H.row(j).head(used) = h.head(used);
            w.noalias() -= Q.leftCols(used) * h.head(used);
            // Twice is enough (Parlett): the basis stays orthogonal to rounding.
            h.head(used).noalias() = Q.leftCols(used).transpose() * w;
            w.noalias() -= Q.leftCols(used) * h.head(used);
            beta = w.norm();
            if (!(beta > 1e-14 * H.col(j).head(used).norm())) {
                // An invariant subspace, maybe not that of the largest eigenvalue.
                beta = 0;
                w = detail::scattered_vector(N, used);
                for (int pass = 0; pass < 2; ++pass) {
                    h.head(used).noalias() = Q.leftCols(used).transpose() * w;
                    w.noalias() -= Q.leftCols(used) * h.head(used);
                }
            }
            q = w.normalized();
        }
        const auto projected = detail::small_spectrum(H.topLeftCorner(used, used));
        const double earlier = pair.value;
        pair.value = projected.values[used - 1];
        pair.residual = beta * std::abs(projected.vectors(used - 1, used - 1));
        const bool settled =
            run > 0 && pair.value - earlier <= options.settled * std::abs(pair.value);
        const bool last = run == options.restarts || m == N || settled ||
                          pair.residual <= options.tolerance * std::abs(pair.value);
        kept = last ? 1 : std::max<Index>(1, used / 3);
        best.resize(N, kept);
        for (Index j = 0; j < kept; ++j) {
            best.col(j).noalias() = Q.leftCols(used) * projected.vectors.col(used - kept + j);
        }
        Q.leftCols(kept) = best;
        if (last) break;
        H.topLeftCorner(kept, kept).setZero();
        H.diagonal().head(kept) = projected.values.tail(kept);
    }
    pair.vector = Q.col(kept - 1).normalized().cwiseQuotient(root);
    return pair;
}

}  // namespace taut
