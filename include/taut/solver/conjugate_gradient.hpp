// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <type_traits>

#include "detail/gradient_cycle.hpp"

namespace taut {

/// Conjugate gradients, preconditioned by TwoLevel, as a Solver for symmetric positive definite
/// matrices (M. R. Hestenes, E. Stiefel, 1952): no factorisation, and memory linear in springs.
///
/// In double the iterations run in float, on the residual in double of what they have reached
/// (iterative refinement: J. H. Wilkinson, "Rounding errors in algebraic processes", 1963), as long
/// as that helps.
///
/// Stops when ‖b − A x‖ ≤ tolerance·‖b‖, or where rounding leaves it above: error() is the true
/// one. A direction p with pᵀAp ≤ 0 shows an indefinite matrix and is reported as
/// Eigen::NumericalIssue; eight times as many iterations as unknowns as Eigen::NoConvergence.
/// @tparam Dim  the matrix consists of full Dim × Dim blocks; 1 fits every matrix
template <class Scalar_, int Dim>
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
    /// Of the last solve.
    Index iterations() const { return iterations_; }
    /// ‖b − A x‖/‖b‖ after the last solve, of the x that it returned.
    Scalar error() const { return error_; }
    /// Of the last factorize() or solve().
    Eigen::ComputationInfo info() const { return info_; }

    /// Fails unless the pattern has full Dim × Dim blocks, diagonal ones included.
    void analyzePattern(const SparseMatrix<Scalar>& A) {
        A_.set_pattern(A);
        x_.setZero(A.rows());
        r_.setZero(A.rows());
        analyzed_ = false;
        if constexpr (mixed) {
            rounded_.copy_pattern(A_);
            fast_.analyze(rounded_);
        }
    }
    /// Copies the values of A and makes the preconditioner; cost: a few passes over A.
    void factorize(const SparseMatrix<Scalar>& A) {
        A_.set_values(A);
        fast_usable_ = factorized_ = false;
        if constexpr (mixed) {
            // With no entry above 1 only what is far below all others leaves the range of Fast.
            scale_ = 1 / A_.largest_diagonal();
            rounded_.copy_values(A_, scale_);
            fast_usable_ = fast_.preconditioner.factorize(rounded_);
        }
        info_ = fast_usable_ || factorize_exactly() ? Eigen::Success : Eigen::NumericalIssue;
    }
    /// The solution of A x = b, started from 0; kept until the next solve.
    const Vector& solve(const Vector& b) const;

private:
    // An iteration waits for memory, which this halves.
    using Fast = std::conditional_t<std::is_same_v<Scalar, double>, float, Scalar>;
    static constexpr bool mixed = !std::is_same_v<Fast, Scalar>;

    bool factorize_exactly() const;
    void improve_fast(const Vector& b, Scalar norm, Index cap) const;
    /// r_ ← b − A x_
    void set_residual(const Vector& b, Scalar norm) const {
        A_.multiply(x_, r_);
        r_ = b - r_;
        error_ = r_.norm() / norm;
    }

    solver_detail::BlockMatrix<Scalar, Dim> A_;
    solver_detail::BlockMatrix<Fast, Dim> rounded_;  // scale_ · A where mixed
    Scalar scale_ = 1;
    Scalar tolerance_ = Scalar(1e-3);
    // solve() is const, as in Eigen's solvers.
    mutable solver_detail::GradientCycle<Fast, Dim> fast_;
    mutable solver_detail::GradientCycle<Scalar, Dim> exact_;
    mutable bool fast_usable_ = false;  // for these values
    mutable bool analyzed_ = false;     // whether exact_ knows the pattern
    mutable bool factorized_ = false;   // and the values
    mutable Vector x_, r_;              // N: solution, residual
    mutable Index iterations_ = 0;
    mutable Scalar error_ = 0;
    mutable Eigen::ComputationInfo info_ = Eigen::InvalidInput;
};

/// Makes exact_ ready, unless it is. @returns whether that succeeds
template <class Scalar_, int Dim>
bool ConjugateGradient<Scalar_, Dim>::factorize_exactly() const {
    if (!analyzed_) exact_.analyze(A_);
    analyzed_ = true;
    if (!factorized_) factorized_ = exact_.preconditioner.factorize(A_);
    return factorized_;
}

template <class Scalar_, int Dim>
auto ConjugateGradient<Scalar_, Dim>::solve(const Vector& b) const -> const Vector& {
    iterations_ = 0;
    error_ = 0;
    x_.setZero();
    if (!fast_usable_ && !factorized_) return x_;
    const Scalar norm = b.norm();
    info_ = Eigen::Success;
    if (norm == 0) return x_;
    r_ = b;
    error_ = norm / norm;  // NaN where b is not finite
    const Index cap = 8 * b.size();
    while (!(error_ <= tolerance_)) {
        if (fast_usable_) {
            improve_fast(b, norm, cap);
            continue;
        }
        if (!factorize_exactly()) {
            info_ = Eigen::NumericalIssue;
            break;
        }
        const Scalar before = error_;
        exact_.r = r_;
        info_ = exact_.run(A_, tolerance_ * norm, cap, iterations_);
        x_ += exact_.x;
        set_residual(b, norm);
        if (!detail::is_finite(error_)) info_ = Eigen::NumericalIssue;
        // The residual of the recurrence drifts from the true one by rounding. Once more helps,
        // unless the true one is nothing but rounding.
        if (info_ != Eigen::Success || !(2 * error_ <= before)) break;
    }
    return x_;
}

/// x_ ← x_ + A⁻¹ r_ as far as Fast has it, and whether Fast is of use any more.
template <class Scalar_, int Dim>
void ConjugateGradient<Scalar_, Dim>::improve_fast(const Vector& b, Scalar norm, Index cap) const {
    if constexpr (mixed) {
        const Scalar before = error_;
        const Scalar size = r_.norm();
        fast_.r = (r_ / size).template cast<Fast>();
        // A little more than is asked for, in place of a second cycle; but not so much that the
        // recurrence has drifted away. On some matrices it never comes down.
        const Scalar goal = (std::max)(Scalar(0.9) * tolerance_ * norm / size, Scalar(1e-5));
        const Index most = iterations_ + std::clamp(b.size(), Index(1), Index(500));
        fast_usable_ = fast_.run(rounded_, static_cast<Fast>(goal), (std::min)(cap, most),
                                 iterations_) != Eigen::NumericalIssue;
        if (!fast_usable_) return;
        x_ += (size * scale_) * fast_.x.template cast<Scalar>();
        set_residual(b, norm);
        fast_usable_ = error_ <= tolerance_ || 10 * error_ <= before;
        if (!(error_ <= before)) {
            x_.setZero();
            r_ = b;
            error_ = r_.norm() / norm;
        }
    }
}

}  // namespace taut
