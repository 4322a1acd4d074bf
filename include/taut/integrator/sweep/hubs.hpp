// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
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
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    std::vector<int> end(at(places) + 1, 0);  // of the springs from each place to later ones
    for (const auto& spring : springs) ++end[at(spring.a) + 1];
    for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
    std::vector<HubSpring> later(springs.size());
    auto next = end;
    for (const auto& spring : springs) {
        later[at(next[at(spring.a)]++)] = {spring.a, spring.b, spring.index};
    }

    std::vector<HubSpring> result;
    result.reserve(springs.size());
    constexpr int none = -1;
    std::vector<int> handed(at(places), none);      // the last one handed to each place, in later
    std::vector<int> before(springs.size(), none);  // the one handed to that place before
    const auto by_tip = [](const HubSpring& s, const HubSpring& t) {
        return s.tip != t.tip ? s.tip < t.tip : s.index < t.index;
    };
    for (int p = 0; p < places; ++p) {
        const auto mine = static_cast<std::ptrdiff_t>(result.size());
        for (int s = handed[at(p)]; s != none; s = before[at(s)]) {
            result.push_back({p, later[at(s)].hub, later[at(s)].index});
        }
        const int first = end[at(p)];
        const int last = end[at(p) + 1];
        const int count = last - first + static_cast<int>(result.size()) - static_cast<int>(mine);
        const int surplus = count % star_size <= last - first ? count % star_size : 0;
        std::sort(later.begin() + first, later.begin() + last, by_tip);
        for (int s = first; s < first + surplus; ++s) {
            before[at(s)] = std::exchange(handed[at(later[at(s)].tip)], s);
        }
        result.insert(result.end(), later.begin() + first + surplus, later.begin() + last);
        std::sort(result.begin() + mine, result.end(), by_tip);
    }
    return result;
}

}  // namespace taut::integrator_detail::sweep
