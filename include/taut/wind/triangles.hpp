// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "../step/tile.hpp"
#include "flow.hpp"

// The wind in a sweep. Triangles are computed in pairs with an edge in common, a register of pairs
// at a time; a pair between two blocks in both, like a spring. Words beside those of
// step/sweep.hpp:
//
//   pair          two triangles with an edge in common
//   row           pairs side by side in planes: a register of them             triangle_rows.hpp
//   four          four pairs on planes of points                              triangle_fours.hpp

namespace taut::step_detail {

using network_detail::Air;

/// What the triangles of one tile read and write.
template <class Scalar>
struct WindView : TileView<Scalar> {
    Air<Scalar> air;
};

/// A triangle by the places of its corners.
using PlacedTriangle = std::array<int, 3>;

/// The triangles a b c and d c b by the places of their corners, which meet in the edge b c; b ≤ c.
/// Alone, a triangle has d = b: the second one has no area.
struct TrianglePair {
    std::array<int, 4> corner;

    int lowest() const { return *std::min_element(corner.begin(), corner.end()); }
    int highest() const { return *std::max_element(corner.begin(), corner.end()); }
    /// Whether the corners lie in different blocks.
    bool is_outer(const Blocks& blocks) const {
        return blocks.of(lowest()) != blocks.of(highest());
    }
    /// Appends the tiles that the pair is computed with: in each block that has one of its corners,
    /// before any tile with one of them is moved.
    void add_tiles(const Blocks& blocks, std::vector<int>& tiles) const {
        if (!is_outer(blocks)) return tiles.push_back(lowest() / tile_size);
        for (const int place : corner) tiles.push_back(blocks.first_tile(blocks.of(place)));
    }
};

/// The corners of a triangle's edge opposite to corner k, ascending.
inline std::pair<int, int> edge_opposite(const PlacedTriangle& t, std::size_t k) {
    return std::minmax(t[(k + 1) % 3], t[(k + 2) % 3]);
}
/// The triangle in a pair of its own.
inline TrianglePair pair_of(const PlacedTriangle& t) {
    const auto [b, c] = edge_opposite(t, 0);
    return {{t[0], b, c, b}};
}
/// @returns whether two triangles have just two corners in common; then `pair` is theirs
inline bool join(const PlacedTriangle& s, const PlacedTriangle& t, TrianglePair& pair) {
    for (std::size_t k = 0; k < 3; ++k) {
        const auto edge = edge_opposite(s, k);
        for (std::size_t other = 0; other < 3; ++other) {
            if (edge_opposite(t, other) != edge) continue;
            const auto [a, d] = std::minmax(s[k], t[other]);
            if (a == d) return false;
            pair = {{a, edge.first, edge.second, d}};
            return true;
        }
    }
    return false;
}

/// Of the tiles of each block the first, which is where all of them may be computed.
inline std::vector<int> first_of_blocks(std::vector<int> tiles, const Blocks& blocks) {
    std::sort(tiles.begin(), tiles.end());
    const auto same_block = [&](int s, int t) {
        return blocks.block_of_tile(s) == blocks.block_of_tile(t);
    };
    tiles.erase(std::unique(tiles.begin(), tiles.end(), same_block), tiles.end());
    return tiles;
}

/// The flow past a pair of triangles, before its forces are computed: registers with a pair in each
/// lane. Apart, so that one pair's flow is computed while another's forces wait for a division.
template <class Real>
struct PairFlow {
    network_detail::Flow<Real> at_a, at_d;
};
/// @param x_ab  x_b − x_a, m, and so on   @param v_bc  v_b + v_c, m/s
template <class Real, class Scalar>
EIGEN_ALWAYS_INLINE PairFlow<Real> flow_past_pair(const Air<Scalar>& air,
                                                  const network_detail::Axes<Real>& x_ab,
                                                  const network_detail::Axes<Real>& x_bc,
                                                  const network_detail::Axes<Real>& x_bd,
                                                  const network_detail::Axes<Real>& v_a,
                                                  const network_detail::Axes<Real>& v_bc,
                                                  const network_detail::Axes<Real>& v_d) {
    const network_detail::Axes<Real> past_bc{Real(air.three_velocities[0]) - v_bc[0],
                                             Real(air.three_velocities[1]) - v_bc[1],
                                             Real(air.three_velocities[2]) - v_bc[2]};
    return {{x_ab, x_bc, {past_bc[0] - v_a[0], past_bc[1] - v_a[1], past_bc[2] - v_a[2]}},
            {x_bd, x_bc, {past_bc[0] - v_d[0], past_bc[1] - v_d[1], past_bc[2] - v_d[2]}}};
}

}  // namespace taut::step_detail
