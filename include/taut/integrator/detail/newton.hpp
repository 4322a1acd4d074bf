// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/status.hpp"
#include "step_equation.hpp"
#include "step_objective.hpp"

namespace taut::detail {

/// Newton's method on the objective of the nonlinear implicit step, with a line search.
template <class System>
class Newton {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;

    /// Moves `state` by a step of h, from the better of the linearised and the inertial move.
    /// @param dv       Δv of the linearised step, of the free particles
    /// @param options  newton_iterations, the linearised one included, and tolerance
    /// @param solve    Status solve(b, du): factorises equation.matrix() = A, du ← A⁻¹ b
    template <class Options, class Solve>
    Report step(const System& system, State& state, const VectorX<Scalar>& dv, Scalar h,
                const Options& options, StepEquation<System>& equation, Solve&& solve);

private:
    double residual() const { return objective_.residual(g_); }
    bool line_search(const System& system, const StepEquation<System>& equation, Scalar& value);

    StepObjective<System> objective_;
    Points<Scalar, Dim> u_, g_;    // iterate, m, and its gradient, kg·m
    Points<Scalar, Dim> u1_, g1_;  // a trial
    Points<Scalar, Dim> x_;        // positions of the iterate, m
    VectorX<Scalar> b_, du_;       // of the free particles
};

/// Halves du_ until it lowers φ or, where differences of φ drown in rounding, its gradient.
template <class System>
bool Newton<System>::line_search(const System& system, const StepEquation<System>& equation,
                                 Scalar& value) {
    const Scalar slope = -b_.dot(du_);
    Scalar t = 1;
    for (int halving = 0; halving < 16; ++halving, t /= 2) {
        u1_ = u_;
        equation.scatter(t, du_, u1_);
        const Scalar next = objective_.evaluate(system, u1_, g1_);
        const bool lower = next < value + Scalar(1e-4) * t * slope;
        if (lower || (objective_.not_above(next, value) && g1_.norm() < g_.norm() / 2)) {
            u_.swap(u1_);
            g_.swap(g1_);
            value = next;
            return true;
        }
    }
    return false;
}

template <class System>
template <class Options, class Solve>
Report Newton<System>::step(const System& system, State& state, const VectorX<Scalar>& dv, Scalar h,
                            const Options& options, StepEquation<System>& equation, Solve&& solve) {
    objective_.begin(system, state, h);
    u_ = h * state.v;
    equation.scatter(h, dv, u_);
    Scalar value = objective_.evaluate(system, u_, g_);
    const Scalar inertial = objective_.evaluate(system, objective_.inertial(), g1_);
    if (!(value <= inertial)) {
        u_ = objective_.inertial();
        g_.swap(g1_);
        value = inertial;
    }
    bool stuck = false;
    for (int i = 1; i < options.newton_iterations && !stuck && residual() > options.tolerance;
         ++i) {
        x_ = state.x + u_;
        equation.gather(g_, b_);
        b_ = -b_;
        du_.setZero(b_.size());
        // Close to the solution the true K is definite and converges quadratically, K⁺ linearly.
        Status status = Status::not_positive_definite;
        if (residual() < 0.1) {
            equation.update_values(system, state.x, x_, h, false);
            status = solve(b_, du_);
        }
        if (status != Status::ok) {
            du_.setZero();
            equation.update_values(system, state.x, x_, h, true);
            status = solve(b_, du_);
        }
        if (status != Status::ok) return {status};
        stuck = !line_search(system, equation, value);
    }
    Report report;
    report.residual = residual();
    const bool rounding = stuck && report.residual <= objective_.rounding(system);
    if (!(report.residual <= options.tolerance) && !rounding) {  // NaN too
        report.status = Status::not_converged;
        return report;
    }
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) state.v.col(i) = u_.col(i) / h;
    }
    state.x += u_;
    return report;
}

}  // namespace taut::detail
