// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../conditions/velocity_verlet.hpp"
#include "detail/explicit_steps.hpp"
#include "detail/last_state.hpp"

namespace taut {

/// Velocity Verlet:  v½ = v + ½h M⁻¹f,  x⁺ = x + h v½,  v⁺ = v½ + ½h M⁻¹f⁺  with f⁺ = f(x⁺, v½).
///
/// Order 2 without damping (order 1 with), one force evaluation a step: f⁺ serves the next step as
/// long as nobody touches the state or the system in between. In (x, v½) it is symplectic Euler, so
/// it has that limit, 2/√k_max without damping [T10].
template <class System>
class VelocityVerlet {
    static_assert((require_system<System>(), true));

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = ExplicitOptions;
    static constexpr Method method = Method::velocity_verlet;
    static constexpr int order = method::VelocityVerlet::order;

    /// Keeps a reference: the system must outlive the stepper.
    explicit VelocityVerlet(const System& system, const Options& options = {})
        : system_(&system), steps_(options) {}
    explicit VelocityVerlet(const System&&, const Options& = {}) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);
    /// For the guard, which books the work of a SpringSystem's steps.
    void watch(step_detail::StepWatch<Scalar, System::Dim>* by) { steps_.watch(by); }

private:
    const System* system_;
    integrator_detail::ExplicitSteps<System> steps_;
    integrator_detail::LastState<State> last_;  // that the kept force belongs to
};

template <class System>
template <class AnyState>
Report VelocityVerlet<System>::step(AnyState& state, Scalar h, Index count) {
    const bool known = last_.is(*system_, state);
    const Report report = steps_.run_verlet(*system_, state, h, count, known);
    if (!report) last_.forget();
    if (report && report.iterations > 0) last_.keep(*system_, state);
    return report;
}

}  // namespace taut
