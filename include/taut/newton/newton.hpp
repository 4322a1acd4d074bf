// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the module constraints.

#include <type_traits>

#include "../constraints/detail/held_particles.hpp"
#include "../integrator/detail/linearised_step.hpp"
#include "../integrator/detail/step_loop.hpp"
#include "../conditions/implicit_euler.hpp"
#include "../solver/sparse_cholesky.hpp"
#include "detail/newton_method.hpp"

namespace taut {

/// Implicit Euler by the nonlinear step, solved:
///
///     M (v⁺ − v) = h(f(x⁺) − D(x)v⁺),  x⁺ = x + h v⁺,
///
/// by Newton's method from the linearised step of ImplicitEuler, with a line search on the
/// objective of the step. Where the energy is convex, [T24] holds, as Options::tolerance states it.
/// constraints() are those of ConstrainedEuler.
/// @tparam Solver  as for ImplicitEuler; a direct one lets the iterations converge quadratically
template <class System, class Solver = SparseCholesky<typename System::Scalar>>
class NewtonEuler {
    static_assert(network_detail::is_spring_system_v<System>,
                  "taut::NewtonEuler: needs a SpringSystem; for matrices one linear solve is "
                  "exact: taut::ImplicitEuler");

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    static constexpr Method method = Method::implicit_euler;
    static constexpr int order = method::ImplicitEuler::order;

    /// When a step is solved.
    struct Options {
        /// Linear solves of a step at most, ≥ 1; not_converged if they do not reach the tolerance.
        int iterations = 100;
        /// On the residual r of the nonlinear equation, > 0, in three quotients: of each particle
        /// ‖r_i‖ over the sizes of the momenta and impulses that meet in it, at the step's end or
        /// at the inertial move; |v⁺ᵀr| over the stake T + V + |W|; where energy_never_rises_v what
        /// the step gains over the same stake. Rounding alone may lift them above it.
        ///
        /// The promise of a step that is ok, with the kinetic energy T and the springs' V before
        /// it, T⁺ and V⁺ after it, the work W of gravity and external force in it, J, where
        /// energy_never_rises_v and what is pinned or constrained is at rest [T24]:
        ///
        ///     T⁺ + V⁺ − T − V − W ≤ tolerance·(T + V + |W|) + R(x) + R(x⁺)
        ///                                            + 64ε(T + V + |W| + T⁺ + V⁺)
        ///     R(x) = Σ (tension·ρ_s + ½·stiffness_bound·ρ_s²) + Σ m_i‖gravity‖ρ_i,
        ///
        /// over springs s of ends a and b and free particles i, ε that of Scalar, ρ_i = 4ε‖x_i‖,
        /// ρ_s = ρ_a + ρ_b: R is what the rounding of positions can do. A step that cannot be
        /// solved so far, of a stiffness beyond the solver's digits say, is refused.
        double tolerance = 1e-6;
    };

    /// Keeps a reference: the system must outlive the stepper. Options out of range go to fail().
    explicit NewtonEuler(const System& system) : NewtonEuler(system, Options()) {}
    /// The same with options.
    NewtonEuler(const System& system, const Options& options);
    explicit NewtonEuler(const System&&) = delete;
    NewtonEuler(const System&&, const Options&) = delete;

    /// Change them between steps at will. Those of pinned particles have no effect.
    ParticleConstraints<Scalar, Dim>& constraints() { return held_.constraints(); }
    /// As of ConstrainedEuler.
    const Points<Scalar, Dim>& constraint_forces() const { return held_.forces(); }

    /// As ConstrainedEuler::step, but the report's residual is that of the nonlinear equation, as
    /// Options::tolerance has it.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1) {
        if (const Report report = held_.examine(system_->size()); !report) return report;
        return loop_.run(*system_, state, h, count, [&](State& own) { return advance(own, h); });
    }
    /// As of ImplicitEuler.
    template <class Change>
    void configure(Change&& change) {
        step_.factors().configure(change);
    }
    /// The solver used last.
    const Solver& solver() const { return step_.factors().solver(); }

private:
    Report advance(State& state, Scalar h);

    const System* system_;
    Options options_;
    integrator_detail::StepLoop<State> loop_;
    integrator_detail::LinearisedStep<System, Solver> step_;
    integrator_detail::HeldParticles<Scalar, Dim> held_;
    integrator_detail::NewtonMethod<System> newton_;
};

template <class System, class Solver>
NewtonEuler<System, Solver>::NewtonEuler(const System& system, const Options& options)
    : system_(&system), options_(options) {
    if (options.iterations < 1) {
        fail("NewtonEuler: iterations is ", options.iterations, "; it must be >= 1");
    }
    require_positive("NewtonEuler", "tolerance", options.tolerance);
}

template <class System, class Solver>
Report NewtonEuler<System, Solver>::advance(State& state, Scalar h) {
    Report report = step_.solve(*system_, state, h, held_);
    if (!report) return report;
    if (step_.dv().size() == 0) {  // nothing free
        step_.move(state, h);
        return report;
    }
    report = newton_.step(
        *system_, state, step_.dv(), h, options_, step_.equation(),
        [&](const VectorX<Scalar>& b, VectorX<Scalar>& dx) {
            return step_.solve_for(b, dx, h, held_);
        },
        [&](Points<Scalar, Dim>& g) { held_.constraints().filter(g); });
    held_.clear_forces();
    if (held_.active() && report) {
        const auto& r = newton_.whole_gradient(*system_);
        held_.set_forces([&](Index i) { return (r.col(i) / (h * h)).eval(); });
    }
    return report;
}

}  // namespace taut
