// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>

#include "../core/method.hpp"
#include "detail/step_equation.hpp"
#include "detail/step_loop.hpp"

namespace taut {

/// Implicit Euler by one linearised solve a step [T6]:
///     (M + hD + h²K) v⁺ = M v + h(f − Kx),  x⁺ = x + h v⁺.
///
/// On a SpringSystem K⁺ stands for K, so the matrix is positive definite at every pose and every h
/// [T27]. The pattern is analysed once for a topology; springs are factorised at every step,
/// constant matrices once for each h.
/// @tparam Solver  Eigen's sparse solver interface (analyzePattern, factorize, solve, info). Not
///                 SimplicialLDLT: it calls an indefinite matrix a success.
template <class System, class Solver = Eigen::SimplicialLLT<SparseMatrix<typename System::Scalar>>>
class ImplicitEuler {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr Method method = Method::implicit_euler;
    static constexpr int order = 1;
    static constexpr bool symmetric =
        !std::is_same_v<std::decay_t<System>, GeneralLinearSystem<Scalar>>;

    static_assert((require_system<System>(), true));
    static_assert((require_solver<Solver, Scalar>(), true));
    static_assert(symmetric || !is_symmetric_solver_v<Solver>,
                  "taut::ImplicitEuler: a GeneralLinearSystem needs an unsymmetric solver "
                  "(taut::Umfpack, Eigen::SparseLU); a symmetric one would read one triangle only");

    /// Keeps a reference: the system must outlive the stepper.
    explicit ImplicitEuler(const System& system) : system_(&system) {}
    explicit ImplicitEuler(const System&&) = delete;

    /// Takes `count` steps of h, s, finite and > 0. On failure the state is as it was before.
    /// The report's residual is that of the last linear solve, relative to its right-hand side.
    Report step(State& state, Scalar h, Index count = 1) {
        return loop_.run(*system_, state, h, count, [&] { return advance(state, h); });
    }
    const Solver& solver() const { return solver_; }

private:
    Report advance(State& state, Scalar h);

    const System* system_;
    detail::StepLoop<State> loop_;
    detail::StepEquation<System> equation_;
    Solver solver_;
    bool factorized_ = false;  // solver_ holds the factors of equation_.matrix()
    VectorX<Scalar> b_;        // N, N·s
    VectorX<Scalar> dv_;       // N, m/s
};

template <class System, class Solver>
Report ImplicitEuler<System, Solver>::advance(State& state, Scalar h) {
    Report report;
    if (equation_.update_pattern(*system_)) {
        solver_.analyzePattern(equation_.matrix());
        factorized_ = false;
    }
    if (equation_.update_values(*system_, state, h) || !factorized_) {
        solver_.factorize(equation_.matrix());
        factorized_ = solver_.info() == Eigen::Success;
        if (!factorized_) {
            return {symmetric ? Status::not_positive_definite : Status::solver_failed};
        }
    }
    equation_.load(*system_, state, h, b_);
    dv_ = solver_.solve(b_);
    if (solver_.info() != Eigen::Success || !dv_.allFinite()) {
        report.status = Status::solver_failed;
        for (Index i = 0; i < dv_.size() && report.where < 0; ++i) {
            if (!std::isfinite(dv_[i])) report.where = equation_.particle(i);
        }
        return report;
    }
    const Scalar norm = b_.norm();
    b_.noalias() -= equation_.matrix() * dv_;
    report.residual = norm > 0 ? static_cast<double>(b_.norm() / norm) : 0;
    equation_.add_to_velocity(dv_, state);
    state.x += h * state.v;
    return report;
}

}  // namespace taut
