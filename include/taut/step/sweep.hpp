// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// How steps are taken, and the words of this folder: README.md.

#include "steps.hpp"

namespace taut::step_detail {

/// Explicit steps of a SpringSystem.
template <class System>
class Sweep {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;

    /// From now on run, run_ahead and run_verlet show their states to that; null ends it.
    void watch(StepWatch<Scalar, Dim>* by) { steps_.watch(by); }
    /// Takes `count` steps of h, s. @param update  see PlaceUpdate::move
    /// @returns whether the new state is finite; else `state` is not touched
    template <class AnyState, class Update>
    bool run(const System& system, AnyState& state, Scalar h, Index count, int threads,
             const Update&) {
        load(system, state, 0, false);
        return steps_.run(Forces<false>(plan_), state, h, count, threads, move<Update>);
    }
    /// Where the last call came to, finite or not.
    void store(State<Scalar, Dim>& last) const { steps_.store(plan_.layout(), 0, 0, last); }
    /// The same with the springs one step ahead: they pull along their new direction, push along
    /// the old one [T42].
    template <class AnyState, class Update>
    bool run_ahead(const System& system, AnyState& state, Scalar h, Index count, int threads,
                   const Update&) {
        load(system, state, h, ForcePlan<System>::pushes);
        return steps_.run(Forces<true>(plan_), state, h, count, threads, move<Update>);
    }
    /// Takes `count` > 0 steps of velocity Verlet.
    /// @param go_on  whether state and system are as the last call of this left them
    template <class AnyState>
    bool run_verlet(const System& system, AnyState& state, Scalar h, Index count, int threads,
                    bool go_on) {
        load(system, state, 0, false);
        return steps_.run_verlet(Forces<false>(plan_), state, h, count, threads, go_on);
    }
    /// Takes `count` steps of h, s: v⁺ = v + h a, x⁺ = x + h v⁺, by accelerations that are
    /// corrected all together.
    /// @tparam Ahead   whether springs pull as in run_ahead
    /// @param correct  correct(a, v): of accelerations and velocities by particle, PlaceVectors
    template <bool Ahead = false, class AnyState, class Correct>
    bool run_corrected(const System& system, AnyState& state, Scalar h, Index count, int threads,
                       const Correct& correct) {
        // The acceleration takes the place of the new x, which must not be that of the old one.
        load(system, state, Ahead ? h : Scalar(0), Ahead);
        return steps_.template run_corrected<Ahead>(Forces<Ahead>(plan_), state, h, count, threads,
                                                    correct);
    }

private:
    template <bool Ahead>
    using Forces = typename ForcePlan<System>::template Forces<Ahead>;
    template <class Update>
    static constexpr typename Steps<Scalar, Dim>::Move move =
        &PlaceUpdate<Scalar>::template move<Update>;

    /// Brings all members up to date.
    /// @param both  whether springs that push take their positions as they are, too
    template <class AnyState>
    void load(const System& system, const AnyState& state, Scalar ahead, bool both) {
        const bool new_plan = plan_.update(system);
        const bool alpha = static_cast<Scalar>(system.rayleigh().stiffness_proportional) > 0;
        steps_.load({system.gravity(), system.rayleigh(), system.inverse_mass().data(),
                     system.revision(), system.external_forces()},
                    plan_.layout(), new_plan, state, ahead,
                    {plan_.damped() || alpha || plan_.has_outside(), plan_.has_outside() || both});
    }

    ForcePlan<System> plan_;
    Steps<Scalar, Dim> steps_;
};

}  // namespace taut::step_detail
