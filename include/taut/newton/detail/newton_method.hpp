// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/detail/bisection.hpp"
#include "../../core/status.hpp"
#include "../../integrator/detail/spring_equation.hpp"
#include "step_judge.hpp"
#include "step_objective.hpp"

namespace taut::integrator_detail {

/// Newton's method on the objective of the nonlinear implicit step, with a line search.
template <class System>
class NewtonMethod {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    using Moves = Points<Scalar, Dim>;

    /// Moves `state` by a step of h, from the better of the linearised and the inertial move.
    /// @param dv       Δv of the linearised step, of the free particles
    /// @param options  iterations, the linearised solve included, and tolerance
    /// @param solve    Status solve(b, du): factorises equation.matrix() = A, du ← A⁻¹ b
    /// @param filter   filter(g), Dim × n: takes what constraints forbid out of moves and forces
    template <class Options, class Solve, class Filter>
    Report step(const System& system, State& state, const VectorX<Scalar>& dv, Scalar h,
                const Options& options, StepEquation<System>& equation, Solve&& solve,
                Filter&& filter);
    /// ∇φ at the last step's end without the filter, Dim × n, kg·m: constraints give it over h².
    const Moves& whole_gradient(const System& system) {
        objective_.evaluate(system, u_, g1_);
        return g1_;
    }

private:
    /// A ← M + hD(x₀) + h²K(x_), the second derivative of the step's objective; K⁺ for K if
    /// `project`.
    void set_matrix(const System& system, const Moves& x0, Scalar h, bool project,
                    StepEquation<System>& equation);
    template <class Filter>
    bool line_search(const System& system, const StepEquation<System>& equation, Scalar& value,
                     Scalar rounding, Filter&& filter);

    StepObjective<System> objective_;
    StepJudge<System> judge_;
    Moves u_, g_;                   // iterate, m, and its gradient, kg·m
    Moves u1_, g1_;                 // a trial
    Moves x_;                       // positions of the iterate, m
    VectorX<Scalar> b_, du_;        // of the free particles
    SparseMatrix<Scalar> inertia_;  // M + hD
};

template <class System>
void NewtonMethod<System>::set_matrix(const System& system, const Moves& x0, Scalar h, bool project,
                                      StepEquation<System>& equation) {
    const double step = static_cast<double>(h);
    SparseMatrix<Scalar>& A = equation.matrix();
    if (inertia_.nonZeros() != A.nonZeros()) inertia_ = A;
    const auto& tangent = equation.tangent();
    tangent.assemble(system, x0, matrices::M + step * matrices::D, inertia_);
    tangent.assemble(system, x_, step * step * (project ? matrices::K_plus : matrices::K), A);
    Eigen::Map<VectorX<Scalar>>(A.valuePtr(), A.nonZeros()) +=
        Eigen::Map<const VectorX<Scalar>>(inertia_.valuePtr(), inertia_.nonZeros());
}

/// Moves u_ along du_ to where φ is no larger and its slope at most half as steep, by bisection.
/// Slopes decide, since differences of φ soon drown in rounding, and since a slack spring that
/// becomes taut bends φ sharply.
template <class System>
template <class Filter>
bool NewtonMethod<System>::line_search(const System& system, const StepEquation<System>& equation,
                                       Scalar& value, Scalar rounding, Filter&& filter) {
    const Scalar slope = -b_.dot(du_);
    // A whole move that is not taken has gone too far: φ falls at 0 and no longer at 1.
    detail::Bisection<Scalar> search(0, 1, 0, 39);
    for (Scalar t = 1; search.open(); t = search.middle()) {
        u1_ = u_;
        equation.free().add(t, du_, u1_);
        const Scalar next = objective_.evaluate(system, u1_, g1_);
        filter(g1_);
        equation.free().gather(g1_, b_);
        const Scalar bent = b_.dot(du_);
        const bool below = objective_.not_above(next, value + rounding);
        if (below && bent < -slope / 2 && (bent > slope / 2 || t == 1)) {
            u_.swap(u1_);
            g_.swap(g1_);
            value = next;
            return true;
        }
        if (t < 1) search.narrow(below && bent < 0);
    }
    return false;
}

template <class System>
template <class Options, class Solve, class Filter>
Report NewtonMethod<System>::step(const System& system, State& state, const VectorX<Scalar>& dv,
                                  Scalar h, const Options& options, StepEquation<System>& equation,
                                  Solve&& solve, Filter&& filter) {
    objective_.begin(system, state, h, filter);
    judge_.begin(system, state, h, objective_);
    u_ = h * state.v;
    equation.free().add(h, dv, u_);
    Scalar value = objective_.evaluate(system, u_, g_);
    filter(g_);
    u1_ = objective_.inertial() - u_;
    filter(u1_);
    u1_ += u_;
    const Scalar inertial = objective_.evaluate(system, u1_, g1_);
    if (!(value <= inertial) || !detail::is_finite(value)) {
        filter(g1_);
        u_.swap(u1_);
        g_.swap(g1_);
        value = inertial;
    }
    Report report;
    report.solves = 1;
    bool stuck = false;
    const auto judge = [&] {
        return judge_.judge(system, objective_, u_, g_, options.tolerance, filter);
    };
    auto verdict = judge();
    while (report.solves < options.iterations && !stuck && !verdict.solved) {
        ++report.solves;
        x_ = state.x + u_;
        equation.free().gather(g_, b_);
        b_ = -b_;
        du_.setZero(b_.size());
        // Close to the solution the true K is definite and converges quadratically, K⁺ linearly.
        report.status = Status::not_positive_definite;
        if (objective_.force_residual(g_) < 0.1) {
            set_matrix(system, state.x, h, false, equation);
            report.status = solve(b_, du_);
        }
        if (!report) {
            du_.setZero();
            set_matrix(system, state.x, h, true, equation);
            report.status = solve(b_, du_);
        }
        if (!report) return report;
        stuck = !line_search(system, equation, value, verdict.rounding, filter);
        if (!stuck) verdict = judge();
    }
    report.residual = verdict.residual;
    if (!verdict.solved) {
        report.status = Status::not_converged;
        return report;
    }
    for (const Index i : equation.free()) state.v.col(i) = u_.col(i) / h;
    state.x += u_;
    return report;
}

}  // namespace taut::integrator_detail
