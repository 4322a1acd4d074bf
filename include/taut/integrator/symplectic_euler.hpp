// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../conditions/symplectic_euler.hpp"
#include "detail/explicit_steps.hpp"

namespace taut {

/// Symplectic (semi-implicit) Euler [T5]:  v⁺ = v + h M⁻¹ f(x, v),  x⁺ = x + h v⁺  (the new v).
///
/// Stable up to 2/√k_max without damping, at a pose [T10]. A scene that moves through poses may
/// gain energy below every pose's limit: step it by EnergyStableEuler, or under the guard.
template <class System>
class SymplecticEuler {
    static_assert((require_system<System>(), true));

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = ExplicitOptions;
    static constexpr Method method = Method::symplectic_euler;
    static constexpr int order = method::SymplecticEuler::order;

    /// Keeps a reference: the system must outlive the stepper.
    explicit SymplecticEuler(const System& system, const Options& options = {})
        : system_(&system), steps_(options) {}
    explicit SymplecticEuler(const System&&, const Options& = {}) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before.
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
Report SymplecticEuler<System>::step(AnyState& state, Scalar h, Index count) {
    return steps_.run(*system_, state, h, count, integrator_detail::KickAndDrift{});
}

}  // namespace taut
