// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../conditions/explicit_euler.hpp"
#include "detail/explicit_steps.hpp"

namespace taut {

/// Explicit Euler [T4]:  v⁺ = v + h M⁻¹ f(x, v),  x⁺ = x + h v  (the old v).
///
/// Never stable without damping [T9]; Stability says up to which h, and inside which window of
/// Rayleigh damping, it is.
template <class System>
class ExplicitEuler {
    static_assert((require_system<System>(), true));

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = ExplicitOptions;
    static constexpr Method method = Method::explicit_euler;
    static constexpr int order = method::ExplicitEuler::order;

    /// Keeps a reference: the system must outlive the stepper.
    explicit ExplicitEuler(const System& system, const Options& options = {})
        : system_(&system), steps_(options) {}
    explicit ExplicitEuler(const System&&, const Options& = {}) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);

private:
    const System* system_;
    integrator_detail::ExplicitSteps<System> steps_;
};

template <class System>
template <class AnyState>
Report ExplicitEuler<System>::step(AnyState& state, Scalar h, Index count) {
    return steps_.run(*system_, state, h, count, integrator_detail::DriftAndKick{});
}

}  // namespace taut
