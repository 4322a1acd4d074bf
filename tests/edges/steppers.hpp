// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/conditions/visit.hpp>
#include <taut/taut.hpp>

#include <tuple>

// The steppers that solve no system, for whatever tries each of them: the one list.

namespace edges {

/// A stepper as a value, with what Taut says of its method.
template <class Stepper>
struct Kind {
    using Type = Stepper;
    static constexpr const char* name = taut::name(Stepper::method);
    static constexpr taut::method::AnyPose any_pose = taut::method::any_pose(Stepper::method);
};

template <class System>
using Explicit =
    std::tuple<Kind<taut::ExplicitEuler<System>>, Kind<taut::SymplecticEuler<System>>,
               Kind<taut::VelocityVerlet<System>>, Kind<taut::EnergyStableEuler<System>>>;

template <class... Descriptors>
constexpr int count_explicit(taut::method::List<Descriptors...>) {
    return (0 + ... + (Descriptors::is_implicit ? 0 : 1));
}

/// visit(Kind) of each.
template <class System, class Visit>
void each_explicit(const Visit& visit) {
    static_assert(std::tuple_size_v<Explicit<System>> == count_explicit(taut::method::All{}),
                  "an explicit method has no stepper in the list of edges/steppers.hpp");
    std::apply([&](auto... kind) { (visit(kind), ...); }, Explicit<System>());
}

}  // namespace edges
