// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>

#include "step_loop.hpp"

// What Guarded and Adaptive share: the Wrapper concept of docs/concepts.md.

namespace taut::integrator_detail {

template <class Stepper>
struct stepped_system;
template <template <class...> class Stepper, class System, class... Policies>
struct stepped_system<Stepper<System, Policies...>> {
    using type = System;
};

/// A wrapper's stepper: one of its own, or one that outlives it.
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

/// A wrapper's copy of an engine's arrays, in the system's precision.
template <class State>
class ViewedState {
public:
    /// Gives the copy to advance(State&), and copies it back if that got anywhere. Arrays that
    /// hold what the last call left there are not read: they may be less precise.
    template <class View, class Advance>
    auto advance(View& view, Advance&& advance) {
        model_detail::require_state<State, View>();
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

}  // namespace taut::integrator_detail
