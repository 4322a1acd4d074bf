// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../conditions/implicit_euler.hpp"
#include "detail/linearised_step.hpp"
#include "detail/step_loop.hpp"

namespace taut {

/// Implicit Euler by one linearised solve a step [T6]:
///
///     (M + hD + h²K) v⁺ = M v + h(f − Kx),  x⁺ = x + h v⁺.
///
/// On a SpringSystem K⁺ stands for K, so the matrix is positive definite at every pose and every h
/// [T27]. The pattern is analysed once for a topology. Springs are factorised at every step;
/// constant matrices once for each h, and the factors of the last two h are kept.
///
/// The default solver of springs is ConjugateGradient to 1e-3 of the right-hand side: on hanging
/// cloths of 1e3 to 1e5 N/m its error in the positions of a step was below 0.06 of what the step
/// itself was off (steps of 1/60 and 1/480 s, beside eight of h/8). SparseCholesky and other direct
/// solvers are exact to rounding; docs/modules.md says where they are the faster ones: many steps
/// on one factor, and chains in one dimension. Every solve starts from 0, so a step depends on the
/// state alone.
/// @tparam Solver  Eigen's sparse solver interface (analyzePattern, factorize, solve, info). Not
///                 SimplicialLDLT: it calls an indefinite matrix a success.
template <class System, class Solver = DefaultSolver<System>>
class ImplicitEuler {
    static_assert((integrator_detail::require_implicit<System, Solver>(), true));

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    static constexpr Method method = Method::implicit_euler;
    static constexpr int order = method::ImplicitEuler::order;
    static constexpr bool symmetric = integrator_detail::StepEquation<System>::symmetric;

    /// Keeps a reference: the system must outlive the stepper.
    explicit ImplicitEuler(const System& system) : system_(&system) {}
    explicit ImplicitEuler(const System&&) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before. The report's residual is that of the last linear solve, relative to its
    /// right-hand side.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);
    /// change(solver) for every solver that the stepper keeps: to set a tolerance, a cap of
    /// iterations.
    template <class Change>
    void configure(Change&& change) {
        step_.factors().configure(change);
    }
    /// The solver used last.
    const Solver& solver() const { return step_.factors().solver(); }
    /// Factorisations so far.
    std::int64_t factorizations() const { return step_.factors().count(); }

private:
    const System* system_;
    integrator_detail::StepLoop<State> loop_;
    integrator_detail::LinearisedStep<System, Solver> step_;
};

template <class System, class Solver>
template <class AnyState>
Report ImplicitEuler<System, Solver>::step(AnyState& state, Scalar h, Index count) {
    return loop_.run(*system_, state, h, count, [&](State& own) {
        return step_.advance(*system_, own, h, integrator_detail::NothingHeld());
    });
}

}  // namespace taut

#if defined(TAUT_COMPILED)
#include "../compiled_implicit.hpp"
#endif
