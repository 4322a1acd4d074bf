// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "../../proof/lanczos.hpp"

namespace taut::proof_detail {

/// Approximate eigenpairs of a real n × n matrix A.
template <class Real>
struct ComplexRitzPairs {
    using Value = std::complex<Real>;
    VectorX<Value> value;
    VectorX<Real> residual;  ///< the norm of Az − value·z for each vector z of unit length
    MatrixX<Real> basis;     ///< n × m, orthonormal
    MatrixX<Value> inner;    ///< m × m: the vectors in the basis

    VectorX<Value> vector(Index j) const { return basis * inner.col(j); }
};

/// Arnoldi's process without restart (W. E. Arnoldi 1951). @param apply  y = apply(q), both n
template <class Real, class Apply>
ComplexRitzPairs<Real> arnoldi(Apply&& apply, Index n, Index steps) {
    Index m = (std::min)(steps, n);
    MatrixX<Real> Q(n, m);
    MatrixX<Real> H = MatrixX<Real>::Zero(m, m);  // QᵀAQ
    VectorX<Real> q = VectorX<Real>(scattered_vector(n)).normalized();
    Real next = 0;
    for (Index j = 0; j < m; ++j) {
        Q.col(j) = q;
        VectorX<Real> w = apply(q);
        const Real norm = w.norm();
        for (int pass = 0; pass < 2; ++pass) {
            const VectorX<Real> h = Q.leftCols(j + 1).transpose() * w;
            w.noalias() -= Q.leftCols(j + 1) * h;
            H.col(j).head(j + 1) += h;
        }
        next = w.norm();
        if (!(next > 1e-13 * norm)) {  // an invariant subspace: all its values are exact
            m = j + 1;
            next = 0;
        } else if (j + 1 < m) {
            H(j + 1, j) = next;
            q = w / next;
        }
    }
    H.conservativeResize(m, m);  // a block would have the eigensolver compiled a second time
    const Eigen::EigenSolver<MatrixX<Real>> projected(H);
    ComplexRitzPairs<Real> pairs;
    pairs.value = projected.eigenvalues();
    pairs.inner = projected.eigenvectors();
    pairs.residual = next * pairs.inner.row(m - 1).cwiseAbs();
    Q.conservativeResize(Eigen::NoChange, m);
    pairs.basis = std::move(Q);
    return pairs;
}

}  // namespace taut::proof_detail
