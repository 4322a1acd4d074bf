// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../network/state_view.hpp"

namespace taut::integrator_detail {

/// The state that a stepper left behind, to tell whether anybody has touched it or the system's
/// force since.
template <class State>
class LastState {
public:
    template <class System, class AnyState>
    void keep(const System& system, const AnyState& state) {
        if constexpr (network_detail::is_state_view_v<AnyState>) {
            // As stored: else arrays of less precision would always seem touched.
            state.copy_to(state_);
        } else {
            state_ = state;
        }
        force_revision_ = system.force_revision();
        kept_ = true;
    }
    void forget() { kept_ = false; }
    template <class System, class AnyState>
    bool is(const System& system, const AnyState& state) const {
        using Scalar = typename State::Scalar;
        return kept_ && system.force_revision() == force_revision_ &&
               state_.x.cols() == state.x.cols() && state_.v.cols() == state.v.cols() &&
               state.x.cols() > 0 && static_cast<Scalar>(state.time) == state_.time &&
               state.x.template cast<Scalar>() == state_.x &&
               state.v.template cast<Scalar>() == state_.v;
    }
    const State& state() const { return state_; }

private:
    State state_;
    std::uint64_t force_revision_ = 0;
    bool kept_ = false;
};

}  // namespace taut::integrator_detail
