// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "two_level.hpp"

namespace taut {

/// Preconditioned conjugate gradients as a Solver for symmetric positive definite matrices
/// (M. R. Hestenes, E. Stiefel, 1952): no factorisation, memory linear in springs, and a start from
/// the last solution where the caller has one.
///
/// Stops when ‖b − A x‖ ≤ tolerance·‖b‖, or where rounding leaves it above: error() is the true
/// one. A direction p with pᵀAp ≤ 0 shows an indefinite matrix and is reported as
/// Eigen::NumericalIssue; the cap of iterations as Eigen::NoConvergence.
/// @tparam Dim             the matrix consists of full Dim × Dim blocks; 1 fits every matrix
/// @tparam Preconditioner  TwoLevel, BlockJacobi or IncompleteCholesky
template <class Scalar_, int Dim, class Preconditioner = TwoLevel<Scalar_, Dim>>
class ConjugateGradient {
public:
    using Scalar = Scalar_;
    using Vector = VectorX<Scalar>;
    enum { UpLo = Eigen::Lower | Eigen::Upper };  // symmetric: what a step checks solvers for

    /// @param tolerance  relative residual, > 0 and < 1
    void setTolerance(Scalar tolerance) {
        if (!(tolerance > 0) || !(tolerance < 1)) {
            fail("ConjugateGradient::setTolerance: tolerance is ", tolerance,
                 "; it must be > 0 and < 1");
        }
        tolerance_ = tolerance;
    }
    /// 1e-3 unless set.
    Scalar tolerance() const { return tolerance_; }
    /// @param iterations  cap of one solve, ≥ 1; by default twice the number of unknowns
    void setMaxIterations(Index iterations) {
        if (iterations < 1) {
            fail("ConjugateGradient::setMaxIterations: iterations is ", iterations,
                 "; it must be >= 1");
        }
        max_iterations_ = iterations;
    }
    /// Of the last solve.
    Index iterations() const { return iterations_; }
    /// ‖b − A x‖/‖b‖ after the last solve, of the x that it returned.
    Scalar error() const { return error_; }
    /// Of the last factorize() or solve().
    Eigen::ComputationInfo info() const { return info_; }

    /// Fails unless the pattern has full Dim × Dim blocks, diagonal ones included.
    void analyzePattern(const SparseMatrix<Scalar>& A) {
        A_.set_pattern(A);
        preconditioner_.analyze(A_);
        for (Vector* v : {&x_, &r_, &z_, &p_, &q_}) v->setZero(A.rows());
    }
    /// Copies the values of A and makes the preconditioner; cost: one pass over A or two.
    void factorize(const SparseMatrix<Scalar>& A) {
        A_.set_values(A);
        factorized_ = preconditioner_.factorize(A_);
        info_ = factorized_ ? Eigen::Success : Eigen::NumericalIssue;
    }
    /// The solution of A x = b, started from 0; kept until the next solve.
    const Vector& solve(const Vector& b) const {
        x_.setZero();
        return solve_from_x(b);
    }
    /// Starts from `guess`, unless its residual is not finite or above 10‖b‖.
    const Vector& solveWithGuess(const Vector& b, const Vector& guess) const {
        if (&guess != &x_) x_ = guess;
        return solve_from_x(b);
    }

private:
    const Vector& solve_from_x(const Vector& b) const;
    void iterate(Scalar norm) const;
    /// r_ ← b − A x_
    void set_residual(const Vector& b, Scalar norm) const {
        A_.multiply(x_, q_);
        r_ = b - q_;
        error_ = r_.norm() / norm;
    }

    solver_detail::BlockMatrix<Scalar, Dim> A_;
    bool factorized_ = false;
    Scalar tolerance_ = Scalar(1e-3);
    Index max_iterations_ = 0;  // 0: twice the number of unknowns
    // solve() is const, as in Eigen's solvers.
    mutable Preconditioner preconditioner_;
    mutable Vector x_, r_, z_, p_, q_;  // N: solution, residual, P⁻¹r, direction, A p
    mutable Index iterations_ = 0;
    mutable Scalar error_ = 0;
    mutable Eigen::ComputationInfo info_ = Eigen::InvalidInput;
};

template <class Scalar_, int Dim, class Preconditioner>
auto ConjugateGradient<Scalar_, Dim, Preconditioner>::solve_from_x(const Vector& b) const
    -> const Vector& {
    iterations_ = 0;
    error_ = 0;
    if (!factorized_) return x_;
    const Scalar norm = b.norm();
    info_ = Eigen::Success;
    if (norm == 0) {
        x_.setZero();
        return x_;
    }
    set_residual(b, norm);
    // A last Δv of a cloth that turns leaves a residual above ‖b‖, and yet saves iterations: what
    // it leaves is stiff, and the first ones remove it.
    if (!(error_ <= 10)) {
        x_.setZero();
        r_ = b;
        error_ = r_.norm() / norm;
    }
    // The residual of the recurrence drifts from the true one by rounding.
    for (Scalar before = 2 * error_; !(error_ <= tolerance_) && !(2 * error_ > before);) {
        before = error_;
        iterate(norm);
        if (info_ != Eigen::Success) break;
        set_residual(b, norm);
        if (!std::isfinite(error_)) info_ = Eigen::NumericalIssue;
    }
    return x_;
}

/// Conjugate gradients from x_ and its residual r_ until the recurrence has r_ below the tolerance.
template <class Scalar_, int Dim, class Preconditioner>
void ConjugateGradient<Scalar_, Dim, Preconditioner>::iterate(Scalar norm) const {
    const Index cap = max_iterations_ > 0 ? max_iterations_ : 2 * r_.size();
    p_.setZero();
    Scalar rz = 1;
    while (!(error_ <= tolerance_)) {  // a NaN goes on to the checks below
        preconditioner_.apply(A_, r_, z_);
        const Scalar next = r_.dot(z_);
        p_ = z_ + (next / rz) * p_;
        rz = next;
        A_.multiply(p_, q_);
        const Scalar curvature = p_.dot(q_);
        if (!(curvature > 0) || !std::isfinite(curvature)) {
            info_ = Eigen::NumericalIssue;
            return;
        }
        if (iterations_ == cap) {
            info_ = Eigen::NoConvergence;
            return;
        }
        const Scalar step = rz / curvature;
        x_ += step * p_;
        r_ -= step * q_;
        error_ = r_.norm() / norm;
        ++iterations_;
    }
}

}  // namespace taut
