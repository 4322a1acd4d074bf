// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "force_plan.hpp"
#include "state_planes.hpp"

namespace taut::integrator_detail::sweep {

/// The external forces of a SpringSystem but a module's, which goes with the plan's springs.
template <class System>
class Outside {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;

    /// @param time  at which steps begin, s
    void begin(const System& system, Scalar time) {
        forces_ = &system.external_forces();
        state_.time = time;
    }
    /// Lets h, s, pass between two steps.
    void pass(Scalar h) { state_.time += h; }

    /// Whether a force asks for the whole state before every step.
    bool asks_for_state() const { return static_cast<bool>(forces_->whole); }
    /// What that force and the constant ones are at a state, N; empty planes for none.
    Planes<Scalar> at_state(const ForcePlan<System>& plan, const StatePlanes<Scalar>& planes) {
        const auto& constant = forces_->constant;
        if (!asks_for_state() && constant.cols() == 0) return {};
        force_.setZero(Dim, plan.size());
        force_.leftCols(constant.cols()) += constant;
        if (asks_for_state()) {
            state_.x.resize(Dim, plan.size());
            state_.v.resize(Dim, plan.size());
            plan.from_planes(planes.x, state_.x);
            plan.from_planes(planes.v, state_.v);
            forces_->whole(state_, force_);
        }
        const Index size = plan.planes() * plan.stride();
        if (planes_.size() != size) planes_.setZero(size);  // padding takes part in the steps
        plan.to_planes(force_, {planes_.data(), plan.stride()});
        return {planes_.data(), plan.stride()};
    }

    /// What the force of the whole state was last asked at; null without one.
    const typename System::State* state() const { return asks_for_state() ? &state_ : nullptr; }
    /// All that at_state() last gave, N; null where a force is missing in it.
    const typename System::Force* force() const {
        return asks_for_state() && !forces_->outside ? &force_ : nullptr;
    }

private:
    const ExternalForces<Scalar, Dim>* forces_ = nullptr;  // the system's
    typename System::State state_;                         // what a force of the whole state sees
    typename System::Force force_;                         // N
    VectorX<Scalar> planes_;                               // N
};

}  // namespace taut::integrator_detail::sweep
