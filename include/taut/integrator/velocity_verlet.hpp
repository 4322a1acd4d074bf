// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/method.hpp"
#include "detail/last_state.hpp"
#include "detail/step_loop.hpp"

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
    static constexpr Method method = Method::velocity_verlet;
    static constexpr int order = 2;

    /// Keeps a reference: the system must outlive the stepper.
    explicit VelocityVerlet(const System& system) : system_(&system) {}
    explicit VelocityVerlet(const System&&) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1) {
        bool known = last_.is(*system_, state);
        const Report report = loop_.run(*system_, state, h, count, [&](State& own) -> Report {
            if (!known) system_->force(own, f_);
            known = true;
            kick(own, h / 2);
            own.x += h * own.v;
            own.time += h;
            system_->force(own, f_);
            kick(own, h / 2);
            return {};
        });
        report ? last_.keep(*system_, state) : last_.forget();
        return report;
    }

private:
    void kick(State& state, Scalar h) const {
        state.v.array() += h * (f_.array().rowwise() * system_->inverse_mass().transpose().array());
    }

    const System* system_;
    detail::StepLoop<State> loop_;
    decltype(State::x) f_;           // force at the end of the last step, Dim × n, N
    detail::LastState<State> last_;  // what f_ belongs to
};

}  // namespace taut
