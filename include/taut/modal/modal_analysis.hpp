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

/// A bound of all |eigenvalues| of A, after Gershgorin.
template <class Real>
Real gershgorin_bound(const SparseMatrix<Real>& A) {
    VectorX<Real> row = VectorX<Real>::Zero(A.rows());
    for_each_entry(A, [&](Index i, Index, Real value) { row[i] += (std::abs)(value); });
    return (std::max)(row.maxCoeff(), (std::numeric_limits<Real>::min)() * Real(1e20));
}

/// (A + σI)⁻¹ for A = M^-½ K M^-½, as Spectra asks for an operator. σ > 0 keeps the matrix definite
/// where K has zero modes, and grows until it is where K is indefinite.
template <class Real>
class ShiftedInverse {
public:
    using Scalar = Real;

    /// σ is 1e-9 of the bound of A or the least power of 30 above it that makes the matrix
    /// definite.
    ShiftedInverse(const SparseMatrix<Real>& A, Real bound) {
        SparseMatrix<Real> identity(A.rows(), A.rows());
        identity.setIdentity();
        for (sigma_ = Real(1e-9) * bound; sigma_ < 100 * bound; sigma_ *= 30) {
            llt_.compute(SparseMatrix<Real>(A + sigma_ * identity));
            if (definite()) return;
        }
    }
    /// Whether there is such a σ.
    bool definite() const { return llt_.info() == Eigen::Success; }
    Real sigma() const { return sigma_; }

    Index rows() const { return llt_.rows(); }
    Index cols() const { return llt_.cols(); }
    void set_shift(Real) const {}
    void perform_op(const Real* x, Real* y) const {
        Eigen::Map<VectorX<Real>>(y, rows()) =
            llt_.solve(Eigen::Map<const VectorX<Real>>(x, rows()));
    }

private:
    Eigen::SimplicialLLT<SparseMatrix<Real>> llt_;
    Real sigma_ = 0;
};

/// Lanczos vectors of the `count` lowest eigenvalues of A, to the tolerance; dense where most of
/// them are asked for. @param bound  of A's eigenvalues
template <class Real>
Report lanczos_vectors(const SparseMatrix<Real>& A, Index count, const ModalOptions& options,
                       Real bound, MatrixX<Real>& vectors) {
    Report report;
    const Index N = A.rows();
    constexpr Index dense_size = 120;
    if (N <= dense_size || 3 * count > N) {
        const Eigen::SelfAdjointEigenSolver<MatrixX<Real>> dense{MatrixX<Real>(A)};
        if (dense.info() != Eigen::Success) return {Status::not_converged};
        vectors = dense.eigenvectors().leftCols(count);
        return report;
    }
    ShiftedInverse<Real> inverse(A, bound);
    if (!inverse.definite()) return {Status::not_positive_definite};
    try {
        const Index space = (std::min)(N, 2 * count + 20);
        Spectra::SymEigsShiftSolver<ShiftedInverse<Real>> solver(inverse, count, space,
                                                                 -inverse.sigma());
        solver.init();
        solver.compute(Spectra::SortRule::LargestMagn, options.max_iterations,
                       Real(options.tolerance), Spectra::SortRule::SmallestAlge);
        report.iterations = static_cast<int>(solver.num_iterations());
        if (solver.info() != Spectra::CompInfo::Successful) report.status = Status::not_converged;
        vectors = solver.eigenvectors();
    } catch (const std::exception&) {
        report.status = Status::solver_failed;
    }
    return report;
}

/// The `count` lowest eigenvalues k of A, ascending, and their vectors, orthonormal to rounding.
/// The report's residual is the largest ‖Aφ − kφ‖, relative to A's stiffest mode.
template <class Real>
Report lowest_modes(const SparseMatrix<Real>& A, Index count, const ModalOptions& options,
                    VectorX<Real>& k, MatrixX<Real>& vectors) {
    const Real bound = gershgorin_bound(A);
    MatrixX<Real> found;
    Report report = lanczos_vectors(A, count, options, bound, found);
    if (!report) return report;
    // Lanczos vectors are orthonormal up to its tolerance; Rayleigh and Ritz make them so to
    // rounding, and the eigenvalues twice as accurate.
    MatrixX<Real> Q = MatrixX<Real>::Identity(A.rows(), count);
    Q = Eigen::HouseholderQR<MatrixX<Real>>(found).householderQ() * Q;
    const Eigen::SelfAdjointEigenSolver<MatrixX<Real>> ritz{MatrixX<Real>(Q.transpose() * (A * Q))};
    if (ritz.info() != Eigen::Success) return {Status::not_converged, report.iterations};
    k = ritz.eigenvalues();
    vectors = Q * ritz.eigenvectors();
    const MatrixX<Real> left = A * vectors - vectors * k.asDiagonal();
    report.residual = static_cast<double>(left.colwise().norm().maxCoeff() / bound);
    const Real rounding =
        std::sqrt(static_cast<Real>(A.rows())) * std::numeric_limits<Real>::epsilon();
    k = (k.cwiseAbs().array() <= 16 * rounding * bound).select(0, k);
    return report;
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
    const Report report = solver_detail::lowest_modes(A, count, options, found.k, found.shapes);
    if (!report) return report;
    found.shapes = scale.asDiagonal() * found.shapes;
    found.d = found.shapes.cwiseProduct(D * found.shapes).colwise().sum().transpose();
    found.p = found.shapes.transpose() * system.load().template cast<double>();
    basis = std::move(found);
    return report;
}

}  // namespace taut
