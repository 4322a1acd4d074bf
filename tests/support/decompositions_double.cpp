// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/Dense>

#include "../../compiled/dense.hpp"
#include "support/decompositions.hpp"

namespace taut_test {

Eigen::VectorXd spectrum(const Eigen::MatrixXd& A) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

double least_eigenvalue(const Eigen::MatrixXd& A) { return spectrum(A)[0]; }

Modes<Eigen::MatrixXd> symmetric_modes(const Eigen::MatrixXd& A) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

Modes<Eigen::MatrixXd> generalized_modes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(A, B);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
    return A.fullPivLu().solve(B);
}

double determinant(const Eigen::MatrixXd& A) { return A.determinant(); }

}  // namespace taut_test
