// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "../conditions/bdf2.hpp"
#include "../integrator/detail/last_state.hpp"
#include "../integrator/detail/linear_solve.hpp"
#include "../integrator/detail/spring_equation.hpp"
#include "../integrator/detail/step_loop.hpp"

namespace taut {

/// The second-order backward difference formula, by one linearised solve a step. With ω = h/h⁻ the
/// ratio to the last step, c = ω²/(1 + 2ω) and τ = h(1 + ω)/(1 + 2ω) (equal steps: ⅓ and ⅔h),
///
///     M (v⁺ − v − c(v − v⁻)) = τ f(x⁺, v⁺),   x⁺ = x + c(x − x⁻) + τ v⁺ [T29],
/// f linearised about (x, v) with K⁺ for K on springs. K.-J. Choi, H.-S. Ko, "Stable but responsive
/// cloth", SIGGRAPH 2002, at variable steps (E. Hairer, G. Wanner, "Solving ODEs II", V.5).
///
/// A-stable: at equal steps every h is stable where M ≻ 0 and D, K ⪰ 0, with an artificial damping
/// ratio of (hω)³/4 in place of implicit Euler's hω/2. Order 2 on linear systems and where no
/// spring is compressed, damped, or moved by an external force that changes with time: the part of
/// K that K⁺ leaves out, D's dependence on x and that force lag by a step, which is of order 1. One
/// solve does not see a slack spring that becomes taut within the step, so energy may rise for a
/// while: Guarded takes such a step back.
///
/// The first step is implicit Euler (ω = 0 in the formula). So is the next one after the system or
/// the state was changed from outside (a contact, a new velocity of a pin), and after a failure;
/// and one that is more than `max_ratio` times its predecessor, for beyond 1 + √2 the formula is
/// not zero-stable.
/// The default solver moved a cloth by less than 0.03 of what BDF2 is off (0.4 s, steps of 1/60 to
/// 1/960 s).
/// @tparam Solver  as for ImplicitEuler
template <class System, class Solver = DefaultSolver<System>>
class Bdf2 {
    static_assert((integrator_detail::require_implicit<System, Solver>(), true));

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr Method method = Method::bdf2;
    static constexpr int order = method::Bdf2::order;
    static constexpr double max_ratio = 2;
    static constexpr bool symmetric = integrator_detail::StepEquation<System>::symmetric;

    /// Keeps a reference: the system must outlive the stepper.
    explicit Bdf2(const System& system) : system_(&system) {}
    explicit Bdf2(const System&&) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before. The report's residual is that of the last linear solve, relative to its
    /// right-hand side.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);
    /// As of ImplicitEuler.
    template <class Change>
    void configure(Change&& change) {
        solve_.factors().configure(change);
    }
    /// The solver used last.
    const Solver& solver() const { return solve_.factors().solver(); }

private:
    Report advance(State& state, Scalar h);

    const System* system_;
    integrator_detail::StepLoop<State> loop_;
    integrator_detail::StepEquation<System> equation_;
    integrator_detail::LinearSolve<Solver, Scalar> solve_;
    Scalar last_step_ = 0;  // h⁻, s; 0: there is no history
    State past_;            // x⁻ and v⁻, and then what they have become: q and p
    State now_;             // x and v
    integrator_detail::LastState<State> last_;  // what the history belongs to
    VectorX<Scalar> b_;                         // N, N·s
};

template <class System, class Solver>
template <class AnyState>
Report Bdf2<System, Solver>::step(AnyState& state, Scalar h, Index count) {
    if (!last_.is(*system_, state)) last_step_ = 0;
    const Report report = loop_.run(*system_, state, h, count, [&](State& own) {
        const Report advanced = advance(own, h);
        last_step_ = h;
        return advanced;
    });
    report ? last_.keep(*system_, state) : last_.forget();
    return report;
}

template <class System, class Solver>
Report Bdf2<System, Solver>::advance(State& state, Scalar h) {
    const Scalar ratio = last_step_ > 0 ? h / last_step_ : Scalar(0);
    const Scalar w = ratio > static_cast<Scalar>(max_ratio) ? Scalar(0) : ratio;
    const Scalar c = w * w / (1 + 2 * w);
    const Scalar tau = h * (1 + w) / (1 + 2 * w);
    now_ = state;
    if (w == 0) past_ = state;
    past_.v = c * (state.v - past_.v);
    past_.x = c * (state.x - past_.x) + tau * state.v;

    if (equation_.update_pattern(*system_)) solve_.forget_pattern(equation_.matrix().rows());
    equation_.update_values(*system_, state, tau);
    equation_.load(*system_, state, tau, 1, past_.x, b_);
    equation_.add_momentum(*system_, past_.v, b_);
    const Report report = solve_.solve(integrator_detail::StepMatrix<Scalar>::of(equation_, tau),
                                       b_, h, integrator_detail::NothingHeld());
    if (!report) return report;
    state.x += past_.x - tau * state.v;
    equation_.add_to_velocity(solve_.dv(), state);
    state.x += tau * state.v;
    std::swap(past_, now_);
    return report;
}

}  // namespace taut
