// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace taut::network_detail {

/// Makes a range from the least to the largest slope, N/m, hold more slopes.
template <class Real>
void widen(std::pair<Real, Real>& range, std::initializer_list<Real> slopes) {
    for (const Real slope : slopes) {
        range = {(std::min)(range.first, slope), (std::max)(range.second, slope)};
    }
}

/// The least and the largest T′ of a law, N/m, of those at two lengths and, if it lies between
/// them, on both sides of the rest length: all there are, where T′ is monotone but for a kink
/// there.
template <class Law, class Parameters, class Real>
std::pair<Real, Real> slopes_at_ends_and_rest(const Parameters& p, Real L, Real low, Real high) {
    const auto slope = [&](Real l) { return Law::tension_slope(p, L, l); };
    const Real at_low = slope(low);
    std::pair<Real, Real> range{at_low, at_low};
    widen(range, {slope(high)});
    if (low < L && L <= high) widen(range, {slope(std::nextafter(L, Real(0))), slope(L)});
    return range;
}

template <class Law, class Parameters, class Real>
auto slope_range(const Parameters& p, Real L, Real low, Real high, int)
    -> decltype(Law::slope_range(p, L, low, high)) {
    return Law::slope_range(p, L, low, high);
}
template <class Law, class Parameters, class Real>
std::pair<Real, Real> slope_range(const Parameters& p, Real L, Real low, Real high, long) {
    return slopes_at_ends_and_rest<Law>(p, L, low, high);
}

/// The least and the largest T′ of a law at lengths from `low` to `high`, m: by its own slope_range
/// where it has one.
template <class Law, class Parameters, class Real>
std::pair<Real, Real> slope_range(const Parameters& p, Real L, Real low, Real high) {
    return slope_range<Law>(p, L, low, high, 0);
}

}  // namespace taut::network_detail
