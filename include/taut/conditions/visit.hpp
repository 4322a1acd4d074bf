// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <tuple>
#include <utility>

#include "../core/concepts.hpp"
#include "../core/error.hpp"
#include "bdf2.hpp"
#include "energy_stable_euler.hpp"
#include "explicit_euler.hpp"
#include "implicit_euler.hpp"
#include "symplectic_euler.hpp"
#include "velocity_verlet.hpp"

namespace taut {
namespace method {

/// Descriptors, as a type.
template <class... Descriptors>
struct List {};

/// Every method, in the order of the enum: the one list.
using All =
    List<ExplicitEuler, SymplecticEuler, VelocityVerlet, ImplicitEuler, Bdf2, EnergyStableEuler>;

/// What a descriptor must have.
template <class D>
using Description =
    std::tuple<decltype(D::method), decltype(D::name), decltype(D::order), decltype(D::is_implicit),
               typename D::Limit, decltype(D::any_pose), decltype(D::step_quadratic)*,
               decltype(D::spectral_radius(0.0, 0.0, 0.0)), decltype(D::critical_step(0.0, 0.0))>;

/// Whether these are the methods of the enum, each once and in its order.
template <class... Descriptors>
constexpr bool lists_every_method(List<Descriptors...>) {
    int next = 0;
    const bool in_order = ((static_cast<int>(Descriptors::method) == next++) && ...);
    return in_order && next == static_cast<int>(Method::last) + 1;
}

/// True, or it does not compile: every method has a whole descriptor.
template <class... Descriptors>
constexpr bool require_every_method(List<Descriptors...>) {
    static_assert((taut::detail::is_detected_v<Description, Descriptors> && ...),
                  "taut::method: a descriptor lacks a member; method::ExplicitEuler has them all");
    static_assert(
        lists_every_method(List<Descriptors...>{}),
        "taut::method: a method has no descriptor in the list of conditions/visit.hpp, or "
        "not in the order of the enum");
    return true;
}
static_assert(require_every_method(All{}));

/// action(Descriptor{}) with the descriptor of `method`, 0 ≤ method ≤ Method::last, else fail().
template <class Action, class First, class... Rest>
constexpr decltype(auto) visit(List<First, Rest...>, Method method, Action&& action) {
    if (method == First::method) return action(First{});
    if constexpr (sizeof...(Rest) > 0) {
        return visit(List<Rest...>{}, method, action);
    } else {
        fail("method::visit: there is no method ", static_cast<int>(method));
    }
}
/// The same over all methods.
template <class Action>
constexpr decltype(auto) visit(Method method, Action&& action) {
    return visit(All{}, method, action);
}

/// The same for a method with a Limit; where it is Absent, `function` fails by the method's name.
template <class Action>
auto visit_limited(const char* function, Method method, Action&& action) {
    using Answer = decltype(action(SymplecticEuler{}));
    return visit(method, [&](auto descriptor) -> Answer {
        using Descriptor = decltype(descriptor);
        if constexpr (is_absent_v<typename Descriptor::Limit>) {
            fail(function, ": no step of ", Descriptor::name, " is proved safe at a pose; ask ",
                 Descriptor::any_pose == AnyPose::proved
                     ? "energy_limit, which proves steps at every pose"
                     : "for implicit_euler, whose steps are");
        } else {
            return action(descriptor);
        }
    });
}

/// Whether this is what holds the method's steps down.
template <class Limit>
constexpr bool is_limited_by(Method method) {
    return visit(method, [](auto descriptor) {
        return std::is_same_v<typename decltype(descriptor)::Limit, Limit>;
    });
}

/// What is proved of the method at any pose.
constexpr AnyPose any_pose(Method method) {
    return visit(method, [](auto descriptor) { return decltype(descriptor)::any_pose; });
}

/// The descriptors as another type, never called.
template <class... Descriptors>
std::tuple<Descriptors...> as_tuple(List<Descriptors...>);
/// The descriptor of a method known to the compiler.
template <Method method>
using Of = std::tuple_element_t<static_cast<std::size_t>(method), decltype(as_tuple(All{}))>;

}  // namespace method

/// The name as tables, sentences and the programs' JSON spell it; "unknown" for no method.
constexpr const char* name(Method method) {
    if (method < Method{} || method > Method::last) return "unknown";
    return method::visit(method, [](auto descriptor) { return decltype(descriptor)::name; });
}

/// Whether a step solves a linear system.
constexpr bool is_implicit(Method method) {
    return method::visit(method, [](auto descriptor) { return decltype(descriptor)::is_implicit; });
}

}  // namespace taut
