// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "../../core/detail/finite.hpp"
#include "../../core/status.hpp"
#include "../../network/free_particles.hpp"
#include "factor_cache.hpp"

namespace taut::integrator_detail {

/// What a step may hold of the particles, here nothing. A module that holds some gives a class of
/// its own with the same functions.
struct NothingHeld {
    /// Before a step from velocities v, Dim × n; `free` are the particles of the matrix.
    template <class Velocities>
    void begin(const FreeParticles&, const Velocities&) {}
    /// Whether the matrix is another one than A.
    static constexpr bool active() { return false; }
    template <class Matrix>
    const Matrix& matrix(const Matrix& A) {
        return A;
    }
    /// The right-hand side in place of b.
    template <class Matrix, class Vector>
    const Vector& reduce(const Matrix&, const Vector& b) {
        return b;
    }
    /// Δv from the solution.
    template <class Vector>
    void complete(Vector&) {}
    /// Takes what it holds out of b − A Δv, N·s, after a step of h, s.
    template <class Vector, class Scalar>
    void settle(Vector&, Scalar) {}
};

/// The matrix A(τ) of an implicit step, over the degrees of freedom of the free particles.
template <class Scalar>
struct StepMatrix {
    const SparseMatrix<Scalar>& A;
    const FreeParticles& free;
    Scalar tau;      // s
    bool constant;   // whether A is the same whenever τ is
    Status refused;  // what a step is whose A the solver gives up

    template <class Equation>
    static StepMatrix of(const Equation& equation, Scalar tau) {
        return {equation.matrix(), equation.free(), tau, Equation::constant,
                Equation::symmetric ? Status::not_positive_definite : Status::solver_failed};
    }
};

/// A Δv = b of an implicit step: compiled once for all systems.
template <class Solver, class Scalar>
class LinearSolve {
public:
    using Vector = VectorX<Scalar>;

    /// For matrices of another pattern. @param size  their rows
    void forget_pattern(Index size) {
        factors_.forget_pattern();
        dv_.resize(size);
    }
    /// dv() ← A⁻¹ b, then b ← b − A dv(), both without what is held. The report's residual is
    /// relative to b. @param h  the step, s
    template <class Held>
    Report solve(const StepMatrix<Scalar>& matrix, Vector& b, Scalar h, Held&& held);
    /// x ← A⁻¹ b.
    template <class Held>
    Status solve_for(const StepMatrix<Scalar>& matrix, const Vector& b, Vector& x, Held&& held) {
        const Status status = factorize(matrix, held);
        return status == Status::ok ? solve_factorized(matrix, b, x) : status;
    }
    /// Of the free particles, m/s.
    const Vector& dv() const { return dv_; }

    FactorCache<Solver, Scalar>& factors() { return factors_; }
    const FactorCache<Solver, Scalar>& factors() const { return factors_; }

private:
    template <class Held>
    Status factorize(const StepMatrix<Scalar>& matrix, Held&& held) {
        if (!matrix.constant || held_ || held.active()) factors_.forget_values();
        held_ = held.active();
        if (factors_.find(matrix.tau)) return Status::ok;
        return factors_.factorize(held.matrix(matrix.A), matrix.tau) ? Status::ok : matrix.refused;
    }
    Status solve_factorized(const StepMatrix<Scalar>& matrix, const Vector& b, Vector& x);
    /// The particle of the first entry that is not finite, or −1.
    static Index first_not_finite(const FreeParticles& free, const Vector& b);

    FactorCache<Solver, Scalar> factors_;
    bool held_ = false;  // whether factors_ are of a matrix that something is held in
    Vector dv_;
};

template <class Solver, class Scalar>
Status LinearSolve<Solver, Scalar>::solve_factorized(const StepMatrix<Scalar>& matrix,
                                                     const Vector& b, Vector& x) {
    const Solver& solver = factors_.solver();
    x = solver.solve(b);
    switch (solver.info()) {
        case Eigen::Success: return detail::all_finite(x) ? Status::ok : Status::solver_failed;
        case Eigen::NoConvergence: return Status::not_converged;
        default: return matrix.refused;
    }
}

template <class Solver, class Scalar>
Index LinearSolve<Solver, Scalar>::first_not_finite(const FreeParticles& free, const Vector& b) {
    for (Index i = 0; i < b.size(); ++i) {
        if (!detail::is_finite(b[i])) return free[i / (b.size() / free.count())];
    }
    return -1;
}

template <class Solver, class Scalar>
template <class Held>
Report LinearSolve<Solver, Scalar>::solve(const StepMatrix<Scalar>& matrix, Vector& b, Scalar h,
                                          Held&& held) {
    const auto& A = matrix.A;
    if (A.rows() == 0) return {};  // nothing free; not every solver takes 0 × 0
    Report report{factorize(matrix, held)};
    if (!report) return report;
    if (const Index where = first_not_finite(matrix.free, b); where >= 0) {
        return {Status::solver_failed, 0, 0, where};
    }
    const Vector& right = held.reduce(A, b);
    const Scalar norm = right.norm();
    report.solves = 1;
    report.status = solve_factorized(matrix, right, dv_);
    if (!report) {
        report.where = first_not_finite(matrix.free, dv_);
        return report;
    }
    held.complete(dv_);
    b.noalias() -= A * dv_;
    held.settle(b, h);
    report.residual = norm > 0 ? static_cast<double>(b.norm() / norm) : 0;
    return report;
}

}  // namespace taut::integrator_detail
