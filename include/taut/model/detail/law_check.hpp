// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "../../core/error.hpp"

namespace taut::detail {

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
/// the rest length to 4096 times it: every limit would be false. For debug builds.
template <class Law, class Scalar>
void check_law(const typename Law::template Parameters<Scalar>& p, Scalar L) {
    const Scalar bound = Law::stiffness_bound(p, L);
    const Scalar most = bound * (1 + 65536 * std::numeric_limits<Scalar>::epsilon());
    const auto exceeds = [&](Scalar value) { return std::isfinite(value) && value > most; };
    const Scalar unit = L > 0 ? L : Scalar(1);
    for (int i = -24; i <= 24; ++i) {
        const Scalar l = unit * std::exp2(Scalar(i) / 2);
        const Scalar slope = Law::tension_slope(p, L, l);
        const Scalar ratio = Law::tension(p, L, l) / l;
        if (!exceeds(slope) && !exceeds(ratio)) continue;
        fail("SpringSystem::add_spring: ", law_name<Law>().c_str(), " has stiffness_bound ", bound,
             ", but at length ", l, " of rest length ", L, exceeds(slope) ? " T' is " : " T/l is ",
             exceeds(slope) ? slope : ratio);
    }
}

}  // namespace taut::detail
