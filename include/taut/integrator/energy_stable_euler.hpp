// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../conditions/energy_stable_euler.hpp"
#include "detail/explicit_steps.hpp"

namespace taut {

/// An explicit step that cannot gain energy [T42]. With y = x + h v each spring has the tension of
/// its length at y; it pulls along its direction at y and pushes along its direction at x:
///
///     v⁺ = v + h M⁻¹(f − D v + F),  x⁺ = x + h v⁺
///
/// For h ≤ energy_limit(system).certified the energy H = T + U rises by no more than the
/// work h F·v⁺ of external forces F and −h Σ u·f_p of pins of velocity u, f_p what springs and
/// dampers do to them, and by rounding: at any pose, any speed, for all time; steps may differ.
///
/// Order 1: a mode is damped as by implicit Euler at this h, by the ratio hω/2. A law whose
/// `convex` is true reads y alone; one without `monotone` costs its energy twice more.
template <class System>
class EnergyStableEuler {
    static_assert((require_system<System>(), true));
    static_assert(network_detail::is_spring_system_v<System>,
                  "taut::EnergyStableEuler: needs the springs of a SpringSystem");

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = ExplicitOptions;
    static constexpr Method method = Method::energy_stable_euler;
    static constexpr int order = method::EnergyStableEuler::order;

    /// Keeps a reference: the system must outlive the stepper.
    explicit EnergyStableEuler(const System& system, const Options& options = {})
        : system_(&system), steps_(options) {}
    explicit EnergyStableEuler(const System&&, const Options& = {}) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. A pin enters y with
    /// the velocity that the state gives it. On failure the state is as it was before.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);
    /// For the guard, which books the work of a SpringSystem's steps.
    void watch(step_detail::StepWatch<Scalar, System::Dim>* by) { steps_.watch(by); }

private:
    const System* system_;
    integrator_detail::ExplicitSteps<System> steps_;
};

template <class System>
template <class AnyState>
Report EnergyStableEuler<System>::step(AnyState& state, Scalar h, Index count) {
    return steps_.run_ahead(*system_, state, h, count, integrator_detail::KickAndDrift{});
}

}  // namespace taut
