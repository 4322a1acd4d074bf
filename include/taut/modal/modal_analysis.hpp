// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "../core/status.hpp"
#include "../own_matrices/linear_system.hpp"
#include "modal_basis.hpp"

// Needs Spectra (Debian: libspectra-dev) and exceptions, which Spectra throws; the only such
// header.

namespace taut {

/// When modal_analysis stops.
struct ModalOptions {
    double tolerance = 1e-10;  ///< of the eigenvalues, relative, > 0
    int max_iterations = 1000;
};

namespace solver_detail {

/// (A + σI)⁻¹ for A = M^-½ K M^-½, as Spectra asks for an operator. σ > 0 keeps the matrix definite
/// where K has zero modes, and grows until it is where K is indefinite.
class ShiftedInverse {
public:
    using Scalar = double;

    explicit ShiftedInverse(const SparseMatrix<double>& A) : A_(A) {
        Eigen::VectorXd row = Eigen::VectorXd::Zero(A.rows());
        for (Index j = 0; j < A.outerSize(); ++j) {
            for (SparseMatrix<double>::InnerIterator entry(A, j); entry; ++entry) {
                row[entry.row()] += std::abs(entry.value());
            }
        }
        bound_ = std::max(row.maxCoeff(), std::numeric_limits<double>::min() * 1e20);
    }
    /// Whether A + σI could be factorised, σ being 1e-9 of the bound or the least power of 30 above
    /// it that makes the matrix definite.
    bool factorize() {
        SparseMatrix<double> identity(A_.rows(), A_.rows());
        identity.setIdentity();
        for (sigma_ = 1e-9 * bound_; sigma_ < 100 * bound_; sigma_ *= 30) {
            llt_.compute(SparseMatrix<double>(A_ + sigma_ * identity));
            if (llt_.info() == Eigen::Success) return true;
        }
        return false;
    }
    double sigma() const { return sigma_; }
    /// Of all |eigenvalues| of A, after Gershgorin, 1/s².
    double bound() const { return bound_; }

    Index rows() const { return A_.rows(); }
    Index cols() const { return A_.cols(); }
    void set_shift(double) const {}
    void perform_op(const double* x, double* y) const {
        Eigen::Map<Eigen::VectorXd>(y, rows()) =
            llt_.solve(Eigen::Map<const Eigen::VectorXd>(x, rows()));
    }

private:
    const SparseMatrix<double>& A_;
    Eigen::SimplicialLLT<SparseMatrix<double>> llt_;
    double bound_ = 0;
    double sigma_ = 0;
};

/// The `count` lowest eigenpairs of A, ascending: dense where most of them are asked for.
inline Status lowest_eigenpairs(const SparseMatrix<double>& A, Index count,
                                const ModalOptions& options, Report& report, ModalBasis& basis) {
    const Index N = A.rows();
    constexpr Index dense_size = 120;
    if (N <= dense_size || 3 * count > N) {
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense{Eigen::MatrixXd(A)};
        if (dense.info() != Eigen::Success) return Status::not_converged;
        basis.k = dense.eigenvalues().head(count);
        basis.shapes = dense.eigenvectors().leftCols(count);
        return Status::ok;
    }
    ShiftedInverse inverse(A);
    if (!inverse.factorize()) return Status::not_positive_definite;
    try {
        const Index space = std::min(N, 2 * count + 20);
        Spectra::SymEigsShiftSolver<ShiftedInverse> solver(inverse, count, space, -inverse.sigma());
        solver.init();
        solver.compute(Spectra::SortRule::LargestMagn, options.max_iterations, options.tolerance,
                       Spectra::SortRule::SmallestAlge);
        report.iterations = static_cast<int>(solver.num_iterations());
        if (solver.info() != Spectra::CompInfo::Successful) return Status::not_converged;
        basis.k = solver.eigenvalues();
        basis.shapes = solver.eigenvectors();
    } catch (const std::exception&) {
        return Status::solver_failed;
    }
    return Status::ok;
}

}  // namespace solver_detail

/// The lowest `count` modes of a system, by shift-invert Lanczos with a negative shift (Spectra).
/// Take the system at its static equilibrium: a flat net's lowest modes are all mechanisms, and a
/// load moves it along them.
///
/// D. James, D. Pai, "DyRT", SIGGRAPH 2002. One sparse factorisation, and some solves a mode.
/// @returns not_converged, not_positive_definite or solver_failed, with `basis` as it was; residual
///          is the largest ‖Kφ − kMφ‖ in the norm of M⁻¹ (‖φ‖_M = 1), relative to the stiffest mode
/// @throws when count is not in 1 … N
template <class Scalar>
Report modal_analysis(const LinearSystem<Scalar>& system, Index count, ModalBasis& basis,
                      const ModalOptions& options = {}) {
    if (count < 1 || count > system.size()) {
        fail("modal_analysis: count is ", count, "; the system has 1 to ", system.size(), " modes");
    }
    require_positive("modal_analysis", "tolerance", options.tolerance);
    const Eigen::VectorXd scale =
        system.mass().template cast<double>().cwiseSqrt().cwiseInverse();  // M^-½
    const SparseMatrix<double> K = system.stiffness().template cast<double>();
    const SparseMatrix<double> D = system.damping().template cast<double>();
    const SparseMatrix<double> A = scale.asDiagonal() * K * scale.asDiagonal();
    ModalBasis found;
    Report report;
    report.status = solver_detail::lowest_eigenpairs(A, count, options, report, found);
    if (!report) return report;
    // Lanczos vectors are orthonormal up to its tolerance; Rayleigh and Ritz make them so to
    // rounding, and the eigenvalues twice as accurate.
    Eigen::MatrixXd Q = Eigen::MatrixXd::Identity(system.size(), count);
    Q = Eigen::HouseholderQR<Eigen::MatrixXd>(found.shapes).householderQ() * Q;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz{
        Eigen::MatrixXd(Q.transpose() * (A * Q))};
    if (ritz.info() != Eigen::Success) return {Status::not_converged, report.iterations};
    found.k = ritz.eigenvalues();
    found.shapes = Q * ritz.eigenvectors();
    const double bound = solver_detail::ShiftedInverse(A).bound();
    const Eigen::MatrixXd left = A * found.shapes - found.shapes * found.k.asDiagonal();
    report.residual = left.colwise().norm().maxCoeff() / bound;
    const double rounding =
        std::sqrt(static_cast<double>(system.size())) * std::numeric_limits<double>::epsilon();
    found.k = (found.k.array().abs() <= 16 * rounding * bound).select(0, found.k);
    found.shapes = scale.asDiagonal() * found.shapes;
    found.d = found.shapes.cwiseProduct(D * found.shapes).colwise().sum().transpose();
    found.p = found.shapes.transpose() * system.load().template cast<double>();
    basis = std::move(found);
    return report;
}

}  // namespace taut
