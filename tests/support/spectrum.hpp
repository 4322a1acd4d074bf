// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>

namespace taut_test {

/// Eigenvalues of a symmetric matrix, ascending. (A header of its own: it is slow to compile.)
inline Eigen::VectorXd spectrum(const Eigen::MatrixXd& A) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

inline double least_eigenvalue(const Eigen::MatrixXd& A) { return spectrum(A)[0]; }

/// The eigenvalues of K' = M^-1 K of a linear system, 1/s^2, ascending.
template <class LinearSystem>
Eigen::VectorXd stiffness_eigenvalues(const LinearSystem& system) {
    const Eigen::VectorXd scale = system.mass().template cast<double>().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd K = Eigen::MatrixXd(system.stiffness().template cast<double>());
    return spectrum(scale.asDiagonal() * K * scale.asDiagonal());
}

}  // namespace taut_test
