// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "sorted_springs-inl.hpp"
#include "stars.hpp"

namespace taut::integrator_detail::sweep {

inline Buffer<HubSpring> choose_hubs(const Buffer<PlacedSpring>& springs, int places) {
    // By lower ends, and so the springs from each place by their other ends.
    Buffer<int> a(springs.size());
    for (std::size_t s = 0; s < springs.size(); ++s) a[s] = springs[s].a;
    Buffer<int> later = numbers(springs.size());
    sort_by(a, later);
    Buffer<HubSpring> result;
    result.reserve(springs.size());
    Buffer<int> handed(places, -1);          // the last to each
    Buffer<int> before(springs.size(), -1);  // the one handed there before
    const int count = static_cast<int>(springs.size());
    for (int p = 0, first = 0; p < places; ++p) {
        int last = first;
        while (last < count && springs[later[last]].a == p) ++last;
        const std::size_t mine = result.size();
        for (int s = handed[p]; s != -1; s = before[s]) {
            result.push_back({p, springs[s].a, springs[s].index});
        }
        std::reverse(result.begin() + static_cast<std::ptrdiff_t>(mine), result.end());
        const int own = last - first;
        const int surplus = (own + static_cast<int>(result.size() - mine)) % star_size;
        for (const int kept = first + (surplus <= own ? surplus : 0); first != kept; ++first) {
            const int s = later[first];
            before[s] = std::exchange(handed[springs[s].b], s);
        }
        for (; first != last; ++first) {
            const auto& spring = springs[later[first]];
            result.push_back({p, spring.b, spring.index});
        }
    }
    return result;
}

inline Buffer<PlannedStar> plan_stars(const Buffer<HubSpring>& by_hub, const Blocks& blocks) {
    Buffer<PlannedStar> stars;
    const int springs = static_cast<int>(by_hub.size());
    const auto spring = [&](int s) { return by_hub[static_cast<std::size_t>(s)]; };
    for (int s = 0; s < springs;) {
        const int hub = spring(s).hub;
        std::array<int, star_size + 1> places{};  // ascending, like the tips of a hub
        int count = 0;
        for (; count < star_size && s + count < springs && spring(s + count).hub == hub; ++count) {
            places[count] = spring(s + count).tip;
        }
        int at = count;
        for (; at > 0 && places[at - 1] > hub; --at) places[at] = places[at - 1];
        places[at] = hub;
        const bool outer = blocks.of(places[0]) != blocks.of(places[count]);
        for (int i = 0; i <= count; ++i) {
            const int block = blocks.of(places[i]);
            if (i > 0 && block == blocks.of(places[i - 1])) continue;
            const int tile = outer ? blocks.first_tile(block) : places[i] / tile_size;
            stars.push_back({tile, outer, s, count});
        }
        s += count;
    }
    // A star goes no later than those after it, so that springs are read in order.
    int tile = blocks.tiles();
    for (std::size_t i = stars.size(); i-- > 0;) {
        if (!stars[i].outer) tile = stars[i].tile = std::min(tile, stars[i].tile);
    }
    Buffer<int> key(stars.size()), order = numbers(stars.size());
    for (std::size_t i = 0; i < key.size(); ++i) key[i] = 2 * stars[i].tile + !stars[i].outer;
    sort_by(key, order);
    Buffer<PlannedStar> sorted;
    sorted.reserve(stars.size());
    for (const int i : order) sorted.push_back(stars[i]);
    return sorted;
}

}  // namespace taut::integrator_detail::sweep
