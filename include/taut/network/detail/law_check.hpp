// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "../../core/concepts.hpp"
#include "../../core/error.hpp"

namespace taut::network_detail {

/// Takes the place of a law that require_law refuses, and answers whatever is asked, so that the
/// compiler has nothing to add to the sentence.
template <class Refused>
struct AnyLaw {
    static constexpr bool convex = false;

    template <class Scalar>
    struct Parameters {
        template <class... Values>
        Parameters(Values&&...) {}
        void require_valid(const char*) const {}
        template <class Other>
        Parameters<Other> cast() const {
            return {};
        }
    };
    template <class P, class Scalar>
    static Scalar tension(const P&, Scalar, Scalar) {
        return {};
    }
    template <class P, class Scalar>
    static Scalar tension_slope(const P&, Scalar, Scalar) {
        return {};
    }
    template <class P, class Scalar>
    static Scalar energy(const P&, Scalar, Scalar) {
        return {};
    }
    template <class P, class Scalar>
    static Scalar stiffness_bound(const P&, Scalar) {
        return {};
    }
};

/// The law itself, if require_law finds nothing missing.
template <class Law, class Scalar>
using usable_law = std::conditional_t<detail::LawHas<Law, Scalar>::all, Law, AnyLaw<Law>>;

/// What a spring of the law holds, in the public functions that take it.
template <class Law, class Scalar>
using usable_parameters = typename usable_law<Law, Scalar>::template Parameters<Scalar>;

template <class Law>
using monotone_of = std::bool_constant<static_cast<bool>(Law::monotone)>;

/// Whether a law says that its tension never falls (docs/concepts.md).
template <class Law, class = void>
inline constexpr bool is_monotone_v = Law::convex;
template <class Law>
inline constexpr bool is_monotone_v<Law, std::void_t<monotone_of<Law>>> =
    Law::convex || Law::monotone;

/// The law's name as its code spells it.
template <class Law>
std::string law_name() {
#if defined(_MSC_VER) && !defined(__clang__)
    const std::string text = __FUNCSIG__;
    const auto begin = text.find("law_name<") + 9;
    return text.substr(begin, text.rfind(">(void)") - begin);
#else
    const std::string text = __PRETTY_FUNCTION__;
    const auto begin = text.find("Law = ") + 6;
    return text.substr(begin, text.find_first_of(";]", begin) - begin);
#endif
}

/// Fails by law and length if T/l or T′ exceeds the law's bound at one of 49 lengths from 1/4096 of
/// the rest length to 4096 times it: every limit would be false; or if a law that says its tension
/// never falls has T′ < 0 there. For debug builds.
template <class Law, class Scalar>
void check_law(const usable_parameters<Law, Scalar>& p, Scalar L) {
    const Scalar bound = Law::stiffness_bound(p, L);
    const Scalar most = bound * (1 + 65536 * std::numeric_limits<Scalar>::epsilon());
    const auto exceeds = [&](Scalar value) { return detail::is_finite(value) && value > most; };
    const Scalar unit = L > 0 ? L : Scalar(1);
    for (int i = -24; i <= 24; ++i) {
        const Scalar l = unit * std::exp2(Scalar(i) / 2);
        const Scalar slope = Law::tension_slope(p, L, l);
        const Scalar ratio = Law::tension(p, L, l) / l;
        if (is_monotone_v<Law> && slope < bound - most) {
            fail("SpringSystem::add_spring: ", law_name<Law>().c_str(),
                 " says that its tension never falls, but at length ", l, " of rest length ", L,
                 " T' is ", slope);
        }
        if (!exceeds(slope) && !exceeds(ratio)) continue;
        fail("SpringSystem::add_spring: ", law_name<Law>().c_str(), " has stiffness_bound ", bound,
             ", but at length ", l, " of rest length ", L, exceeds(slope) ? " T' is " : " T/l is ",
             exceeds(slope) ? slope : ratio);
    }
}

}  // namespace taut::network_detail
