// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../method/symplectic_euler.hpp"
#include "detail/explicit_steps.hpp"

namespace taut {

/// Symplectic (semi-implicit) Euler [T5]:  v⁺ = v + h M⁻¹ f(x, v),  x⁺ = x + h v⁺  (the new v).
///
/// Stable up to 2/√k_max without damping, at a pose [T10]. For a moving scene take step and damping
/// from `recipe`, which are measured, or from energy_limit(system), which are proved [T34].
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

    /// The stepper's own damping, as shares of the step.
    const StepDamping& damping() const { return steps_.damping(); }

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
