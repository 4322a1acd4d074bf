// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <type_traits>

#include "../core/method.hpp"
#include "../solver/block_ordering.hpp"
#include "detail/factor_cache.hpp"
#include "detail/newton.hpp"
#include "detail/step_equation.hpp"
#include "detail/step_loop.hpp"

namespace taut {
namespace detail {

template <class Solver, class Vector>
using solve_with_guess_of = decltype(std::declval<const Solver&>().solveWithGuess(
    std::declval<const Vector&>(), std::declval<const Vector&>()));

/// In place of Newton's method where one linear solve is exact.
struct NoNewton {};

}  // namespace detail

/// Implicit Euler by one linearised solve a step [T6]:
///     (M + hD + h²K) v⁺ = M v + h(f − Kx),  x⁺ = x + h v⁺.
///
/// On a SpringSystem K⁺ stands for K, so the matrix is positive definite at every pose and every h
/// [T27]. The pattern is analysed once for a topology. Springs are factorised at every step;
/// constant matrices once for each h, and the factors of the last two h are kept.
///
/// Options ask for the nonlinear step instead, M(v⁺ − v) = h(f(x⁺) − D(x)v⁺), by Newton's method
/// from that solve with a line search on the objective of the step: where the energy is convex,
/// [T24] holds.
/// @tparam Solver  Eigen's sparse solver interface (analyzePattern, factorize, solve, info). Not
///                 SimplicialLDLT: it calls an indefinite matrix a success. One with Eigen's
///                 solveWithGuess starts from the last Δv, so that its steps depend on the last
///                 ones within its tolerance.
template <class System, class Solver = Eigen::SimplicialLLT<SparseMatrix<typename System::Scalar>,
                                                            Eigen::Lower, BlockOrdering<>>>
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

    struct Options {
        /// Linear solves of a step at most. 1: the linearised step; more: the nonlinear one, and
        /// not_converged if they do not reach the tolerance. Without effect on matrices.
        int newton_iterations = 1;
        /// On the gradient of the step's objective, relative to that at the inertial positions or
        /// to the momentum; > 0. What rounding leaves passes in any case.
        double tolerance = 1e-6;
    };

    /// Keeps a reference: the system must outlive the stepper.
    explicit ImplicitEuler(const System& system) : ImplicitEuler(system, Options()) {}
    ImplicitEuler(const System& system, const Options& options);
    explicit ImplicitEuler(const System&&) = delete;
    ImplicitEuler(const System&&, const Options&) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before. The report's residual is that of the last linear solve, relative to its
    /// right-hand side; with newton_iterations > 1 that of the nonlinear equation, as
    /// Options::tolerance has it.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1) {
        return loop_.run(*system_, state, h, count, [&](State& own) { return advance(own, h); });
    }
    /// change(solver) for every solver that the stepper keeps: to set a tolerance, a cap of
    /// iterations.
    template <class Change>
    void configure(Change&& change) {
        factors_.configure(change);
    }
    /// The solver used last.
    const Solver& solver() const { return factors_.solver(); }
    /// Factorisations so far.
    std::int64_t factorizations() const { return factors_.count(); }

private:
    static constexpr bool springs = detail::is_spring_system_v<std::decay_t<System>>;
    using Equation = detail::StepEquation<System>;
    using Newton = std::conditional_t<springs, detail::Newton<System>, detail::NoNewton>;

    Report advance(State& state, Scalar h);
    Report solve_linearised(const State& state, Scalar h);
    Status factorize(Scalar h);
    Status solve(const VectorX<Scalar>& b, VectorX<Scalar>& x);

    const System* system_;
    Options options_;
    detail::StepLoop<State> loop_;
    Equation equation_;
    detail::FactorCache<Solver, Scalar> factors_;  // of equation_.matrix()
    Newton newton_;
    VectorX<Scalar> b_;   // N, N·s
    VectorX<Scalar> dv_;  // N, m/s
};

template <class System, class Solver>
ImplicitEuler<System, Solver>::ImplicitEuler(const System& system, const Options& options)
    : system_(&system), options_(options) {
    if (options.newton_iterations < 1) {
        fail("ImplicitEuler: newton_iterations is ", options.newton_iterations,
             "; it must be >= 1");
    }
    require_positive("ImplicitEuler", "tolerance", options.tolerance);
}

template <class System, class Solver>
Status ImplicitEuler<System, Solver>::factorize(Scalar h) {
    if constexpr (Equation::constant) {
        if (factors_.find(h)) return Status::ok;
    } else {
        factors_.forget_values();
    }
    if (factors_.factorize(equation_.matrix(), h)) return Status::ok;
    return symmetric ? Status::not_positive_definite : Status::solver_failed;
}

/// x ← A⁻¹ b, from x as it is where the solver can make use of it.
template <class System, class Solver>
Status ImplicitEuler<System, Solver>::solve(const VectorX<Scalar>& b, VectorX<Scalar>& x) {
    if constexpr (detail::is_detected_v<detail::solve_with_guess_of, Solver, VectorX<Scalar>>) {
        x = factors_.solver().solveWithGuess(b, x);
    } else {
        x = factors_.solver().solve(b);
    }
    switch (factors_.solver().info()) {
        case Eigen::Success: return x.allFinite() ? Status::ok : Status::solver_failed;
        case Eigen::NoConvergence: return Status::not_converged;
        default: return symmetric ? Status::not_positive_definite : Status::solver_failed;
    }
}

/// dv_ ← Δv of the linearised step.
template <class System, class Solver>
Report ImplicitEuler<System, Solver>::solve_linearised(const State& state, Scalar h) {
    if (equation_.update_pattern(*system_)) {
        factors_.forget_pattern();
        dv_.setZero(equation_.matrix().rows());
    }
    if (dv_.size() == 0) return {};  // nothing free; not every solver takes 0 × 0
    equation_.update_values(*system_, state, h);
    equation_.load(*system_, state, h, h, state.v, b_);
    Report report{factorize(h)};
    if (!report) return report;
    if (const Index where = detail::first_not_finite(equation_, b_); where >= 0) {
        return {Status::solver_failed, 0, 0, where};
    }
    report.status = solve(b_, dv_);
    if (!report) {
        report.where = detail::first_not_finite(equation_, dv_);
        return report;
    }
    const Scalar norm = b_.norm();
    b_.noalias() -= equation_.matrix() * dv_;
    report.residual = norm > 0 ? static_cast<double>(b_.norm() / norm) : 0;
    return report;
}

template <class System, class Solver>
Report ImplicitEuler<System, Solver>::advance(State& state, Scalar h) {
    const Report report = solve_linearised(state, h);
    if (!report) {
        dv_.setZero();  // no start for the next solve
        return report;
    }
    if constexpr (springs) {
        if (options_.newton_iterations > 1) {
            return newton_.step(*system_, state, dv_, h, options_, equation_,
                                [&](const VectorX<Scalar>& b, VectorX<Scalar>& dx) {
                                    const Status status = factorize(h);
                                    return status == Status::ok ? solve(b, dx) : status;
                                });
        }
    }
    equation_.add_to_velocity(dv_, state);
    state.x += h * state.v;
    return report;
}

}  // namespace taut
