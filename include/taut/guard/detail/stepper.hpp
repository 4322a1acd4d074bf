// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "../../integrator/detail/guarded_traits.hpp"
#include "../../method/visit.hpp"

namespace taut::guard_detail {

/// Which steps the trial may take: one without a `method` counts as implicit.
template <class Stepper>
constexpr method::AnyPose any_pose_of() {
    return method::Of<integrator_detail::guarded_method<Stepper>()>::any_pose;
}

/// Takes steps by a stepper, or by a call that takes one.
/// @returns whether `count` steps of h, s, were taken
template <class Stepper, class State, class Scalar>
bool take_steps(Stepper& stepper, State& state, Scalar h, Index count) {
    if constexpr (!std::is_invocable_v<Stepper&, State&, Scalar>) {
        return bool(stepper.step(state, h, count));
    } else {
        for (Index i = 0; i < count; ++i) {
            if constexpr (std::is_void_v<decltype(stepper(state, h))>) {
                stepper(state, h);
            } else if (!stepper(state, h)) {
                return false;
            }
        }
        return true;
    }
}

}  // namespace taut::guard_detail
