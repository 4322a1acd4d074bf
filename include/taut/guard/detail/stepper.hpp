// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <type_traits>
#include <utility>

#include "../../core/concepts.hpp"
#include "../../conditions/visit.hpp"
#include "../../integrator/detail/watching.hpp"
#include "../../network/state_view.hpp"

namespace taut::guard_detail {

template <class Stepper>
using method_of = decltype(Stepper::method);
template <class Stepper>
using constraint_forces_of = decltype(std::declval<const Stepper&>().constraint_forces());
template <class Stepper>
using added_kinetic_of = decltype(std::declval<const Stepper&>().added_kinetic(
    std::declval<const typename Stepper::State&>()));

/// Whether what answers to a step is Contacts, which take part in it.
template <class Respond>
using touching_of = decltype(std::declval<const Respond&>().touching());
template <class Respond>
inline constexpr bool is_contacts_v = detail::is_detected_v<touching_of, std::decay_t<Respond>>;
/// Whether it is SelfContact, which has a share of the proved step and joins all parts.
template <class Respond>
using wants_another_of = decltype(std::declval<Respond&>().wants_another());
template <class Respond>
inline constexpr bool is_self_contact_v =
    detail::is_detected_v<wants_another_of, std::decay_t<Respond>>;

struct NoResponse {
    template <class State>
    void operator()(State&) const {}
};

template <class Stepper>
struct stepped_system;
template <template <class...> class Stepper, class System, class... Policies>
struct stepped_system<Stepper<System, Policies...>> {
    using type = System;
};

/// The guard's stepper: one of its own, or one that outlives it.
template <class Stepper>
class HeldStepper {
public:
    template <class... Arguments>
    explicit HeldStepper(std::in_place_t, Arguments&&... arguments)
        : own_(std::in_place, std::forward<Arguments>(arguments)...) {}
    explicit HeldStepper(Stepper& lent) : lent_(&lent) {}

    Stepper& get() { return own_ ? *own_ : *lent_; }
    const Stepper& get() const { return own_ ? *own_ : *lent_; }

private:
    std::optional<Stepper> own_;
    Stepper* lent_ = nullptr;  // used without own_
};

/// The guard's copy of an engine's arrays, in the system's precision.
template <class State>
class ViewedState {
public:
    /// Gives the copy to advance(State&), and copies it back if that got anywhere. Arrays that
    /// hold what the last call left there are not read: they may be less precise.
    template <class View, class Advance>
    auto advance(View& view, Advance&& advance) {
        network_detail::require_state<State, View>();
        if (!is_in(view)) view.copy_to(state_);
        const auto report = advance(state_);
        if (report.advanced > 0) view.copy_from(state_);
        return report;
    }

private:
    template <class Stored, int Dim>
    bool is_in(const StateView<Stored, Dim>& view) const {
        return view.x.cols() == state_.x.cols() && view.v.cols() == state_.v.cols() &&
               view.time == static_cast<double>(state_.time) &&
               view.x == state_.x.template cast<Stored>() &&
               view.v == state_.v.template cast<Stored>();
    }

    State state_;
};

/// Which steps the trial may take: one without a `method` counts as implicit.
template <class Stepper>
constexpr method::AnyPose any_pose_of() {
    if constexpr (detail::is_detected_v<method_of, Stepper>) {
        return method::Of<Stepper::method>::any_pose;
    } else {
        return method::AnyPose::every_step;
    }
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
