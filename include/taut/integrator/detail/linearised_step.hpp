// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "linear_solve.hpp"
#include "spring_equation.hpp"

namespace taut::integrator_detail {

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
    Report solve(const System& system, const State& state, Scalar h, Held&& held) {
        if (equation_.update_pattern(system)) solve_.forget_pattern(equation_.matrix().rows());
        held.begin(equation_.free(), state.v);
        equation_.update_values(system, state, h);
        equation_.load(system, state, h, h, state.v, b_);
        return solve_.solve(StepMatrix<Scalar>::of(equation_, h), b_, h, held);
    }
    /// v ← v + Δv, x ← x + h v.
    void move(State& state, Scalar h) const {
        equation_.add_to_velocity(dv(), state);
        state.x += h * state.v;
    }
    /// Of the free particles, m/s.
    const Vector& dv() const { return solve_.dv(); }

    /// The equation of the last step, whose matrix a module may fill anew.
    Equation& equation() { return equation_; }
    /// x ← A⁻¹ b for the equation's matrix A.
    template <class Held>
    Status solve_for(const Vector& b, Vector& x, Scalar h, Held&& held) {
        return solve_.solve_for(StepMatrix<Scalar>::of(equation_, h), b, x, held);
    }
    FactorCache<Solver, Scalar>& factors() { return solve_.factors(); }
    const FactorCache<Solver, Scalar>& factors() const { return solve_.factors(); }

private:
    Equation equation_;
    LinearSolve<Solver, Scalar> solve_;
    Vector b_;  // N, N·s
};

}  // namespace taut::integrator_detail
