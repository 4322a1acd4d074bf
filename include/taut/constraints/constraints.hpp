// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../integrator/detail/linearised_step.hpp"
#include "../integrator/detail/step_loop.hpp"
#include "../conditions/implicit_euler.hpp"
#include "detail/held_particles.hpp"

namespace taut {

/// ImplicitEuler with particles held in planes, on lines, at points or to velocities: exactly in a
/// direct solve, by filtering in conjugate gradients [T31], as in D. Baraff, A. Witkin, "Large
/// steps in cloth simulation", SIGGRAPH 1998.
/// @tparam Solver  as for ImplicitEuler
template <class System, class Solver = DefaultSolver<System>>
class ConstrainedEuler {
    static_assert((integrator_detail::require_implicit<System, Solver>(), true));

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    static constexpr Method method = Method::implicit_euler;
    static constexpr int order = method::ImplicitEuler::order;

    /// Keeps a reference: the system must outlive the stepper.
    explicit ConstrainedEuler(const System& system) : system_(&system) {}
    explicit ConstrainedEuler(const System&&) = delete;

    /// Change them between steps at will. Those of pinned particles have no effect.
    ParticleConstraints<Scalar, Dim>& constraints() { return held_.constraints(); }
    /// Of the constraints on their particles in the last step, N, Dim × n, zero elsewhere: for
    /// friction, or to decide on a release. Empty (0 columns) if that had none, or failed.
    const Points<Scalar, Dim>& constraint_forces() const { return held_.forces(); }

    /// As ImplicitEuler::step; a constraint on a particle that the system does not have is
    /// invalid_state, at that particle.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1) {
        if (const Report report = held_.examine(system_->size()); !report) return report;
        return loop_.run(*system_, state, h, count,
                         [&](State& own) { return step_.advance(*system_, own, h, held_); });
    }
    /// As of ImplicitEuler.
    template <class Change>
    void configure(Change&& change) {
        step_.factors().configure(change);
    }
    /// The solver used last.
    const Solver& solver() const { return step_.factors().solver(); }

private:
    const System* system_;
    integrator_detail::StepLoop<State> loop_;
    integrator_detail::LinearisedStep<System, Solver> step_;
    integrator_detail::HeldParticles<Scalar, Dim> held_;
};

}  // namespace taut
