// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace taut::detail {

template <class Law, class Parameters, class Real>
auto slope_range(const Parameters& p, Real L, Real low, Real high, int)
    -> decltype(Law::slope_range(p, L, low, high)) {
    return Law::slope_range(p, L, low, high);
}

template <class Law, class Parameters, class Real>
std::pair<Real, Real> slope_range(const Parameters& p, Real L, Real low, Real high, long) {
    const Real at_low = Law::tension_slope(p, L, low);
    std::pair<Real, Real> range = std::minmax(at_low, Law::tension_slope(p, L, high));
    if (!(low < L && L <= high)) return range;
    for (const Real side : {std::nextafter(L, Real(0)), L}) {
        const Real slope = Law::tension_slope(p, L, side);
        range = {std::min(range.first, slope), std::max(range.second, slope)};
    }
    return range;
}

/// The least and the largest T′ of a law at lengths from `low` to `high`, m: by its own slope_range
/// where it has one, else at both ends and on both sides of the rest length, which is enough for a
/// law whose T′ is monotone but for a kink there.
template <class Law, class Parameters, class Real>
std::pair<Real, Real> slope_range(const Parameters& p, Real L, Real low, Real high) {
    return slope_range<Law>(p, L, low, high, 0);
}

}  // namespace taut::detail
