// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>
#include <taut/own_matrices/own_matrices.hpp>

// Dense decompositions for the tests, compiled once: each takes seconds to compile.

namespace taut_test {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using ComplexVector = Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, 1>;
using ComplexMatrix = Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, Eigen::Dynamic>;

/// Eigenvalues, and the eigenvectors as columns.
template <class Matrix>
struct Modes {
    Eigen::Matrix<typename Matrix::Scalar, Eigen::Dynamic, 1> values;
    Matrix vectors;
};

/// Of a symmetric matrix, ascending.
RealVector eigenvalues(const RealMatrix& A);
Eigen::VectorXd spectrum(const Eigen::MatrixXd& A);
double least_eigenvalue(const Eigen::MatrixXd& A);
/// Of K' = M⁻¹K of a linear system, 1/s², ascending.
template <class LinearSystem>
Eigen::VectorXd stiffness_eigenvalues(const LinearSystem& system) {
    const Eigen::VectorXd scale = system.mass().template cast<double>().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd K = Eigen::MatrixXd(system.stiffness().template cast<double>());
    return spectrum(scale.asDiagonal() * K * scale.asDiagonal());
}
/// Of a symmetric matrix, ascending; orthonormal.
Modes<RealMatrix> modes(const RealMatrix& A);
Modes<Eigen::MatrixXd> symmetric_modes(const Eigen::MatrixXd& A);
/// Of A x = λ B x, both symmetric, B positive definite; VᵀBV = 1.
Modes<Eigen::MatrixXd> generalized_modes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Of any matrix, in no order.
ComplexVector general_eigenvalues(const RealMatrix& A);
Modes<ComplexMatrix> general_modes(const RealMatrix& A);

/// A⁻¹B by elimination with full pivoting.
RealMatrix solve(const RealMatrix& A, const RealMatrix& B);
Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

double determinant(const Eigen::MatrixXd& A);

/// Q of QR.
RealMatrix orthogonal(const RealMatrix& A);

}  // namespace taut_test
