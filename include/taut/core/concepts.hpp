// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <utility>

#include "status.hpp"
#include "types.hpp"

namespace taut {
namespace detail {

template <class Void, template <class...> class Operation, class... Args>
struct detector : std::false_type {};
template <template <class...> class Operation, class... Args>
struct detector<std::void_t<Operation<Args...>>, Operation, Args...> : std::true_type {};
template <template <class...> class Operation, class... Args>
inline constexpr bool is_detected_v = detector<void, Operation, Args...>::value;

template <class T>
using scalar_of = typename T::Scalar;
template <class T>
using state_of = typename T::State;
template <class T>
using force_of = decltype(std::declval<const T&>().force(std::declval<const typename T::State&>(),
                                                         std::declval<decltype(T::State::x)&>()));
template <class T>
using size_of = decltype(std::declval<const T&>().size());
template <class T>
using inverse_mass_of = decltype(std::declval<const T&>().inverse_mass());
template <class T>
using revision_of = decltype(std::declval<const T&>().revision());
template <class T>
using force_revision_of = decltype(std::declval<const T&>().force_revision());

template <class Law, class Scalar>
using parameters_of = typename Law::template Parameters<Scalar>;
template <class Parameters>
using require_valid_of = decltype(std::declval<const Parameters&>().require_valid(""));
template <class Parameters, class Law, class Other>
using cast_of = std::enable_if_t<std::is_convertible_v<
    decltype(std::declval<const Parameters&>().template cast<Other>()), parameters_of<Law, Other>>>;
template <class Number, class Scalar>
using number_of = std::enable_if_t<std::is_convertible_v<Number, Scalar>>;
template <class Law, class P, class S>
using tension_of = number_of<
    decltype(Law::tension(std::declval<const P&>(), std::declval<S>(), std::declval<S>())), S>;
template <class Law, class P, class S>
using tension_slope_of =
    number_of<decltype(Law::tension_slope(std::declval<const P&>(), std::declval<S>(),
                                          std::declval<S>())),
              S>;
template <class Law, class P, class S>
using energy_of =
    number_of<decltype(Law::energy(std::declval<const P&>(), std::declval<S>(), std::declval<S>())),
              S>;
template <class Law, class P, class S>
using stiffness_bound_of =
    number_of<decltype(Law::stiffness_bound(std::declval<const P&>(), std::declval<S>())), S>;
template <class Law>
using convex_of = std::bool_constant<static_cast<bool>(Law::convex)>;
template <class Law, class P, class S>
using slope_range_of = std::enable_if_t<
    std::is_convertible_v<decltype(Law::slope_range(std::declval<const P&>(), std::declval<S>(),
                                                    std::declval<S>(), std::declval<S>())),
                          std::pair<S, S>>>;
template <class Law, class Scalar>
using slope_range_name_of = decltype(&Law::template slope_range<Scalar>);

/// What a law has of the Law concept for a system in Scalar, whose analysis is in double. Without
/// Parameters nothing else can be asked, and nothing else counts as missing.
template <class Law, class Scalar,
          bool =
              is_detected_v<parameters_of, Law, Scalar>&& is_detected_v<parameters_of, Law, double>>
struct LawHas {
    using P = parameters_of<Law, Scalar>;
    template <template <class...> class Operation>
    static constexpr bool function = is_detected_v<Operation, Law, P, Scalar>&&
        is_detected_v<Operation, Law, parameters_of<Law, double>, double>;

    static constexpr bool parameters = true;
    static constexpr bool require_valid = is_detected_v<require_valid_of, P>;
    static constexpr bool cast =
        is_detected_v<cast_of, P, Law, float> && is_detected_v<cast_of, P, Law, double>;
    static constexpr bool tension = function<tension_of>;
    static constexpr bool tension_slope = function<tension_slope_of>;
    static constexpr bool energy = function<energy_of>;
    static constexpr bool stiffness_bound = function<stiffness_bound_of>;
    static constexpr bool convex = is_detected_v<convex_of, Law>;
    // One that is there and cannot be called would be passed over, and its slopes with it.
    static constexpr bool slope_range =
        !is_detected_v<slope_range_name_of, Law, Scalar> || function<slope_range_of>;
    static constexpr bool all = require_valid && cast && tension && tension_slope && energy &&
                                stiffness_bound && convex && slope_range;
};
template <class Law, class Scalar>
struct LawHas<Law, Scalar, false> {
    static constexpr bool parameters = false, all = false;
    static constexpr bool require_valid = true, cast = true, tension = true, tension_slope = true,
                          energy = true, stiffness_bound = true, convex = true, slope_range = true;
};

}  // namespace detail

/// The System concept (docs/concepts.md): one readable sentence for each missing member.
template <class T>
constexpr void require_system() {
    static_assert(detail::is_detected_v<detail::scalar_of, T>,
                  "taut::System: needs the type `Scalar`");
    static_assert(detail::is_detected_v<detail::state_of, T>,
                  "taut::System: needs the type `State`, with x, v and time");
    static_assert(detail::is_detected_v<detail::size_of, T>,
                  "taut::System: needs `Index size() const`, the number of particles");
    static_assert(detail::is_detected_v<detail::force_of, T>,
                  "taut::System: needs `void force(const State&, Points& f) const`");
    static_assert(
        detail::is_detected_v<detail::inverse_mass_of, T>,
        "taut::System: needs `inverse_mass() const`, 1/kg for each particle, 0 if pinned");
    static_assert(detail::is_detected_v<detail::revision_of, T>,
                  "taut::System: needs `revision() const`, a number that changes with the system");
    static_assert(
        detail::is_detected_v<detail::force_revision_of, T>,
        "taut::System: needs `force_revision() const`, a number that changes with the force");
}

/// The Law concept (docs/concepts.md), for one Scalar: one readable sentence for each missing
/// member. SpringSystem asks it of each of its laws.
template <class Law, class Scalar>
constexpr void require_law() {
    using Has = detail::LawHas<Law, Scalar>;
    static_assert(Has::parameters,
                  "taut::Law: needs `template <class Scalar> Parameters`, what one spring of the "
                  "law holds (docs/concepts.md, Law)");
    static_assert(Has::require_valid,
                  "taut::Law: Parameters needs `void require_valid(const char* where) const`, "
                  "which fails for values out of range (docs/concepts.md, Law)");
    static_assert(Has::cast,
                  "taut::Law: Parameters needs `template <class Other> Parameters<Other> cast() "
                  "const`, the same in another precision (docs/concepts.md, Law)");
    static_assert(Has::tension,
                  "taut::Law: needs `static Scalar tension(const Parameters<Scalar>& p, Scalar L, "
                  "Scalar l)`, N, for every Scalar (docs/concepts.md, Law)");
    static_assert(Has::tension_slope,
                  "taut::Law: needs `static Scalar tension_slope(const Parameters<Scalar>& p, "
                  "Scalar L, Scalar l)`, N/m, for every Scalar (docs/concepts.md, Law)");
    static_assert(Has::energy,
                  "taut::Law: needs `static Scalar energy(const Parameters<Scalar>& p, Scalar L, "
                  "Scalar l)`, J, for every Scalar (docs/concepts.md, Law)");
    static_assert(Has::stiffness_bound,
                  "taut::Law: needs `static Scalar stiffness_bound(const Parameters<Scalar>& p, "
                  "Scalar L)`, N/m, for every Scalar (docs/concepts.md, Law)");
    static_assert(Has::convex,
                  "taut::Law: needs `static constexpr bool convex`, whether the energy is convex "
                  "in the positions (docs/concepts.md, Law)");
    static_assert(Has::slope_range,
                  "taut::Law: slope_range must be `static std::pair<Scalar, Scalar> "
                  "slope_range(const Parameters<Scalar>& p, Scalar L, Scalar low, Scalar high)`, "
                  "N/m, for every Scalar (docs/concepts.md, Law)");
}

}  // namespace taut
