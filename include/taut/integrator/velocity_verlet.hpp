// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../method/velocity_verlet.hpp"
#include "detail/last_state.hpp"
#include "detail/step_loop.hpp"
#include "explicit_options.hpp"

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
    /// @param options  its damping; one thread whatever it says
    explicit VelocityVerlet(const System& system, const Options& options = {})
        : system_(&system), damping_(options.damping) {
        integrator_detail::require_step_damping<System>(options.damping);
    }
    explicit VelocityVerlet(const System&&, const Options& = {}) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);

    /// The stepper's own damping, as shares of the step.
    const StepDamping& damping() const { return damping_; }

private:
    void force(const State& state, [[maybe_unused]] Scalar h) {
        if constexpr (model_detail::is_spring_system_v<System>) {
            system_->force(state, f_, damping_.times(static_cast<double>(h)));
        } else {
            system_->force(state, f_);
        }
    }
    void kick(State& state, Scalar h) const {
        state.v.array() += h * (f_.array().rowwise() * system_->inverse_mass().transpose().array());
    }

    const System* system_;
    StepDamping damping_;
    Scalar last_h_ = 0;  // of f_
    integrator_detail::StepLoop<State> loop_;
    decltype(State::x) f_;                      // force at the end of the last step, Dim × n, N
    integrator_detail::LastState<State> last_;  // what f_ belongs to
};

template <class System>
template <class AnyState>
Report VelocityVerlet<System>::step(AnyState& state, Scalar h, Index count) {
    // With damping of its own a force belongs to one step size.
    bool known = last_.is(*system_, state) && (!damping_ || h == last_h_);
    const Report report = loop_.run(*system_, state, h, count, [&](State& own) -> Report {
        if (!known) force(own, h);
        known = true;
        kick(own, h / 2);
        own.x += h * own.v;
        own.time += h;
        force(own, h);
        kick(own, h / 2);
        return {};
    });
    if (!report) last_.forget();
    if (report && report.iterations > 0) {
        last_.keep(*system_, state);
        last_h_ = h;
    }
    return report;
}

}  // namespace taut
