// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../model/free_particles.hpp"
#include "factor_cache.hpp"
#include "spring_equation.hpp"

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

/// Implicit Euler's linearised step [T6], [T27], which modules hold particles in or go on from.
template <class System, class Solver>
class LinearisedStep {
    static_assert((require_implicit<System, Solver>(), true));

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Equation = StepEquation<System>;
    using Vector = VectorX<Scalar>;

    /// One step of h, s, in place. The report's residual is relative to the right-hand side.
    template <class Held>
    Report advance(const System& system, State& state, Scalar h, Held&& held) {
        const Report report = solve(system, state, h, held);
        if (report) move(state, h);
        return report;
    }
    /// dv() ← Δv of the step.
    template <class Held>
    Report solve(const System& system, const State& state, Scalar h, Held&& held);
    /// v ← v + Δv, x ← x + h v.
    void move(State& state, Scalar h) const {
        equation_.add_to_velocity(dv_, state);
        state.x += h * state.v;
    }
    /// Of the free particles, m/s.
    const Vector& dv() const { return dv_; }

    /// The equation of the last step, whose matrix a module may fill anew.
    Equation& equation() { return equation_; }
    /// x ← A⁻¹ b for the equation's matrix A.
    template <class Held>
    Status solve_for(const Vector& b, Vector& x, Scalar h, Held&& held) {
        const Status status = factorize(h, held);
        return status == Status::ok ? solve_factorized(b, x) : status;
    }
    FactorCache<Solver, Scalar>& factors() { return factors_; }
    const FactorCache<Solver, Scalar>& factors() const { return factors_; }

private:
    static constexpr Status refused =
        Equation::symmetric ? Status::not_positive_definite : Status::solver_failed;

    template <class Held>
    Status factorize(Scalar h, Held&& held);
    Status solve_factorized(const Vector& b, Vector& x);

    Equation equation_;
    FactorCache<Solver, Scalar> factors_;
    bool held_ = false;  // whether factors_ are of a matrix that something is held in
    Vector b_;           // N, N·s
    Vector dv_;          // N, m/s
};

template <class System, class Solver>
template <class Held>
Status LinearisedStep<System, Solver>::factorize(Scalar h, Held&& held) {
    if (!Equation::constant || held_ || held.active()) factors_.forget_values();
    held_ = held.active();
    if (factors_.find(h)) return Status::ok;
    return factors_.factorize(held.matrix(equation_.matrix()), h) ? Status::ok : refused;
}

template <class System, class Solver>
Status LinearisedStep<System, Solver>::solve_factorized(const Vector& b, Vector& x) {
    x = factors_.solver().solve(b);
    return solve_status(factors_.solver(), x, refused);
}

template <class System, class Solver>
template <class Held>
Report LinearisedStep<System, Solver>::solve(const System& system, const State& state, Scalar h,
                                             Held&& held) {
    const auto& A = equation_.matrix();
    if (equation_.update_pattern(system)) {
        factors_.forget_pattern();
        dv_.resize(A.rows());
    }
    held.begin(equation_.free(), state.v);
    if (A.rows() == 0) return {};  // nothing free; not every solver takes 0 × 0
    equation_.update_values(system, state, h);
    equation_.load(system, state, h, h, state.v, b_);
    Report report{factorize(h, held)};
    if (!report) return report;
    if (const Index where = first_not_finite(equation_, b_); where >= 0) {
        return {Status::solver_failed, 0, 0, where};
    }
    const Vector& right = held.reduce(A, b_);
    const Scalar norm = right.norm();
    report.solves = 1;
    report.status = solve_factorized(right, dv_);
    if (!report) {
        report.where = first_not_finite(equation_, dv_);
        return report;
    }
    held.complete(dv_);
    b_.noalias() -= A * dv_;
    held.settle(b_, h);
    report.residual = norm > 0 ? static_cast<double>(b_.norm() / norm) : 0;
    return report;
}

}  // namespace taut::integrator_detail
