// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <vector>

#include "hubs.hpp"
#include "tile.hpp"

namespace taut::integrator_detail::sweep {

/// Up to four springs with one hub, as one block computes them.
struct PlannedStar {
    int tile;    // that it is computed with
    bool outer;  // whether a place lies in another block
    int first;   // of its springs, among those by hubs
    int count;   // of its springs
};

/// The stars of springs by hubs, tile by tile and the outer ones of each tile first. A star is
/// computed in each block that has one of its places, before any tile with one of them is moved.
inline std::vector<PlannedStar> plan_stars(const std::vector<HubSpring>& by_hub,
                                           const Blocks& blocks) {
    std::vector<PlannedStar> stars;
    const int springs = static_cast<int>(by_hub.size());
    const auto spring = [&](int s) { return by_hub[static_cast<std::size_t>(s)]; };
    for (int s = 0; s < springs;) {
        std::array<int, star_size + 1> places{spring(s).hub};
        int count = 0;
        while (count < star_size && s + count < springs && spring(s + count).hub == places[0]) {
            places[count + 1] = spring(s + count).tip;
            ++count;
        }
        std::sort(places.begin(), places.begin() + count + 1);
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
    for (auto star = stars.rbegin(); star != stars.rend(); ++star) {
        if (!star->outer) tile = star->tile = std::min(tile, star->tile);
    }
    std::sort(stars.begin(), stars.end(), [](const PlannedStar& s, const PlannedStar& t) {
        return std::tuple(s.tile, !s.outer, s.first) < std::tuple(t.tile, !t.outer, t.first);
    });
    return stars;
}

}  // namespace taut::integrator_detail::sweep
