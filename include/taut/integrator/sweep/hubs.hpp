// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "sorted_springs.hpp"

namespace taut::integrator_detail::sweep {

/// A spring seen from one of its ends, the hub; the other end is its tip.
struct HubSpring {
    int hub;
    int tip;
    int index;  // in the set
};

/// A star has so many springs.
inline constexpr int star_size = 4;

/// Chooses an end of each spring for its hub so that nearly all places are the hub of a multiple of
/// four springs: what is more than that, a place hands to the later ends of its springs.
/// @returns the springs by hubs, and by tips for each hub
inline std::vector<HubSpring> choose_hubs(const std::vector<PlacedSpring>& springs, int places) {
    // By lower ends: the springs from each place to later ones.
    auto later = counting_sort(springs, places, [](const auto& spring) { return spring.a; });
    std::vector<HubSpring> result;
    result.reserve(springs.size());
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> handed(static_cast<std::size_t>(places), none);  // the last to each
    std::vector<std::size_t> before(springs.size(), none);  // the one handed there before
    auto first = later.begin();
    for (int p = 0; p < places; ++p) {
        const auto last =
            std::find_if(first, later.end(), [p](const auto& spring) { return spring.a != p; });
        const auto mine = static_cast<std::ptrdiff_t>(result.size());
        for (auto s = handed[static_cast<std::size_t>(p)]; s != none; s = before[s]) {
            result.push_back({p, later[s].a, later[s].index});
        }
        const auto count = last - first + static_cast<std::ptrdiff_t>(result.size()) - mine;
        const auto surplus = count % star_size <= last - first ? count % star_size : 0;
        std::sort(first, last, [](const auto& s, const auto& t) {
            return s.b != t.b ? s.b < t.b : s.index < t.index;
        });
        for (const auto kept = first + surplus; first != kept; ++first) {
            const auto s = static_cast<std::size_t>(first - later.begin());
            before[s] = std::exchange(handed[static_cast<std::size_t>(first->b)], s);
        }
        for (; first != last; ++first) result.push_back({p, first->b, first->index});
        std::sort(result.begin() + mine, result.end(), [](const auto& s, const auto& t) {
            return s.tip != t.tip ? s.tip < t.tip : s.index < t.index;
        });
    }
    return result;
}

}  // namespace taut::integrator_detail::sweep
