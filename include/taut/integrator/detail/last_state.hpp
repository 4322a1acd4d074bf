// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../core/types.hpp"

namespace taut::detail {

/// The state that a stepper left behind, to tell whether anybody has touched it or the system's
/// force since.
template <class State>
class LastState {
public:
    template <class System>
    void keep(const System& system, const State& state) {
        state_ = state;
        force_revision_ = system.force_revision();
    }
    void forget() { state_.x.resize(Eigen::NoChange, 0); }
    template <class System>
    bool is(const System& system, const State& state) const {
        return system.force_revision() == force_revision_ && state_.x.cols() == state.x.cols() &&
               state.x.cols() > 0 && state.time == state_.time && state.x == state_.x &&
               state.v == state_.v;
    }
    const State& state() const { return state_; }

private:
    State state_;
    std::uint64_t force_revision_ = 0;
};

}  // namespace taut::detail
