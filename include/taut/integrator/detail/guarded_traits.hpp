// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <utility>

#include "../../core/concepts.hpp"
#include "../../method/method.hpp"

namespace taut::integrator_detail {

template <class Stepper>
using method_of = decltype(Stepper::method);
template <class Stepper>
using damping_of = decltype(std::declval<const Stepper&>().damping());
template <class Stepper>
using added_kinetic_of = decltype(std::declval<const Stepper&>().added_kinetic(
    std::declval<const typename Stepper::State&>()));
template <class Stepper>
using constraint_forces_of = decltype(std::declval<const Stepper&>().constraint_forces());

struct NoResponse {
    template <class State>
    void operator()(State&) const {}
};

/// The work that a response claims, J; none if it returns nothing.
template <class Respond, class State>
double claimed_work(Respond& respond, State& state) {
    if constexpr (std::is_void_v<decltype(respond(state))>) {
        respond(state);
        return 0;
    } else {
        return static_cast<double>(respond(state));
    }
}

/// What the guard takes a stepper for; one without a `method` counts as implicit.
template <class Stepper>
constexpr Method guarded_method() {
    if constexpr (detail::is_detected_v<method_of, Stepper>) {
        return Stepper::method;
    } else {
        return Method::implicit_euler;
    }
}

}  // namespace taut::integrator_detail
