// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <cmath>

#include "../support/tolerance.hpp"
#include "../stability/wild_system.hpp"

// Symmetric matrices whose least eigenvalue is known by a closed form, by a Schur complement or by
// long double: definite, or a hair below.

namespace taut_test {

using Sparse = Eigen::SparseMatrix<double>;

inline constexpr double hairs[] = {1e-16, 3e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6};

/// S A S with powers of two: exact, and not a sign of an eigenvalue changes.
inline Sparse badly_scaled(Random& random, const Sparse& A, int range) {
    Eigen::VectorXd s(A.rows());
    for (Index i = 0; i < s.size(); ++i)
        s[i] = std::exp2(static_cast<double>(random.below(2 * range + 1) - range));
    return s.asDiagonal() * A * s.asDiagonal();
}

/// `diagonal` on the diagonal and −1 between neighbours of a p × q grid; eigenvalues diagonal −
/// 2cos(jπ/(p + 1)) − 2cos(lπ/(q + 1)), without the second term for q = 1.
inline Sparse grid(Index p, Index q, double diagonal) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto at = [&](Index i, Index j) { return static_cast<int>(i + p * j); };
    for (Index j = 0; j < q; ++j) {
        for (Index i = 0; i < p; ++i) {
            entries.emplace_back(at(i, j), at(i, j), diagonal);
            const auto join = [&](int other) {
                entries.emplace_back(at(i, j), other, -1);
                entries.emplace_back(other, at(i, j), -1);
            };
            if (i + 1 < p) join(at(i + 1, j));
            if (j + 1 < q) join(at(i, j + 1));
        }
    }
    Sparse A(p * q, p * q);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

inline Real grid_least(Index p, Index q, double diagonal) {
    const Real pi = std::acos(Real(-1));
    const Real second = q > 1 ? 2 * std::cos(pi / static_cast<Real>(q + 1)) : Real(0);
    return static_cast<Real>(diagonal) - 2 * std::cos(pi / static_cast<Real>(p + 1)) - second;
}

/// D + c·11ᵀ off the diagonal: a spectrum by hand, all ones once, dense factor.
inline Sparse constant_off_diagonal(Index n, double diagonal, double off) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Constant(n, n, off);
    A.diagonal().setConstant(diagonal);
    return A.sparseView();
}

/// Random entries with about `degree` neighbours each, diagonally dominant by a little.
inline Eigen::MatrixXd random_graph(Random& random, Index n, Index degree) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    for (Index e = 0; e < n * degree / 2; ++e) {
        const Index i = random.below(n);
        const Index j = (i + 1 + random.below(n - 1)) % n;
        A(i, j) = A(j, i) = random.uniform(-1, 1);
    }
    A.diagonal() = 1.05 * A.cwiseAbs().rowwise().sum();
    A.diagonal().array() += 0.1;
    return A;
}

/// A with its last diagonal entry a hair below what definiteness needs: bᵀB⁻¹b, in long double.
inline bool make_indefinite(Eigen::MatrixXd& A, double hair) {
    const Index n = A.rows();
    const RealMatrix exact = A.cast<Real>();
    const Eigen::LLT<RealMatrix> llt(exact.topLeftCorner(n - 1, n - 1));
    if (llt.info() != Eigen::Success) return false;
    const RealVector b = exact.col(n - 1).head(n - 1);
    const Real schur = b.dot(llt.solve(b));
    if (!(schur > 0)) return false;
    A(n - 1, n - 1) = static_cast<double>(schur * (1 - static_cast<Real>(hair)));
    return static_cast<Real>(A(n - 1, n - 1)) < schur * (1 - 1e-17L);
}

}  // namespace taut_test
