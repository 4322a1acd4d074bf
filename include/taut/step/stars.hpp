// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "sorted_springs.hpp"
#include "tile.hpp"

namespace taut::step_detail {

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
/// @param springs  as SortedSprings has them
/// @returns the springs by hubs, and by tips for each hub
TAUT_COLD Buffer<HubSpring> choose_hubs(const Buffer<PlacedSpring>& springs, int places);

/// Up to four springs with one hub, as one block computes them.
struct PlannedStar {
    int tile;    // that it is computed with
    bool outer;  // whether a place lies in another block
    int first;   // of its springs, among those by hubs
    int count;   // of its springs
};

/// The stars of springs by hubs, tile by tile and the outer ones of each tile first. A star is
/// computed in each block that has one of its places, before any tile with one of them is moved.
TAUT_COLD Buffer<PlannedStar> plan_stars(const Buffer<HubSpring>& by_hub, const Blocks& blocks);

/// Springs with one end in common, by where the points of their ends begin, counted from the
/// block's first. Where there are fewer than four, the rest are gaps from the hub to itself.
struct Star {
    int hub;
    Few<int, star_size> tips;
};

/// The stars of one law, tile by tile, in groups.
struct StarGroups {
    /// Where the stars of a tile end: the outer ones, and all. Whole groups.
    struct Ends {
        int outer, all;
    };
    Buffer<Star> stars;
    Buffer<Ends> ends;  // of each tile
};

}  // namespace taut::step_detail
