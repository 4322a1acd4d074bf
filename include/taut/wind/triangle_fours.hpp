// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../step/quad.hpp"
#include "../step/tile.hpp"
#include "triangles.hpp"

namespace taut::step_detail {

/// Pairs of triangles four at a time, a lane each, on planes of points.
template <class Scalar>
class TriangleFours {
    using Point = Quad<Scalar>;
    using Part = typename Point::Part;

public:
    TriangleFours() = default;
    TriangleFours(const std::vector<TrianglePair>& pairs, const Blocks& blocks);

    /// Adds the forces of the wind on the tile's triangles.
    void add_forces(const WindView<Scalar>& view) const {
        constexpr std::make_integer_sequence<int, Point::parts> parts{};
        const auto tile = static_cast<std::size_t>(view.tile);
        const std::size_t first = tile == 0 ? 0 : end_[tile - 1];
        if (first == end_[tile]) return;
        constexpr std::size_t chunk = 8;
        std::array<FlowOfFour, chunk> flows;
        for (std::size_t f = first; f < end_[tile]; f += chunk) {
            const std::size_t count = (std::min)(chunk, end_[tile] - f);
            for (std::size_t k = 0; k < count; ++k)
                flows[k] = flow_past(view, fours_[f + k], parts);
            for (std::size_t k = 0; k < count; ++k) add_four(view, fours_[f + k], flows[k], parts);
        }
    }

private:
    /// Where the points of one corner of four pairs begin. Where there are fewer pairs, the rest
    /// have all corners in one place: no area, and no force.
    struct Corners {
        std::array<std::uint32_t, 4> in_planes;
        /// Counted from the block's first place; what lies in other blocks goes behind the last
        /// one.
        std::array<std::uint16_t, 4> in_block;
    };
    static_assert(4 * most_of_block <= (std::numeric_limits<std::uint16_t>::max)());
    using Four = std::array<Corners, 4>;  // a, b, c, d
    using FlowOfFour = std::array<PairFlow<Part>, Point::parts>;
    using Vectors = std::array<Point, 4>;
    template <int... i>
    using Numbers = std::integer_sequence<int, i...>;
    static constexpr std::make_integer_sequence<int, 4> all{};

    static Four places(const std::array<TrianglePair, 4>& pairs, const Blocks& blocks, int block);

    template <int... k>
    static EIGEN_ALWAYS_INLINE Vectors load(const Scalar* points, const Corners& at,
                                            Numbers<k...>) {
        return {Point::load(points + at.in_planes[k])...};
    }
    template <int... k>
    static EIGEN_ALWAYS_INLINE Vectors minus(const Vectors& a, const Vectors& b, Numbers<k...>) {
        return {(a[k] - b[k])...};
    }
    template <int... k>
    static EIGEN_ALWAYS_INLINE Vectors plus(const Vectors& a, const Vectors& b, Numbers<k...>) {
        return {(a[k] + b[k])...};
    }
    template <int... k>
    static EIGEN_ALWAYS_INLINE void add(Scalar* forces, const Corners& at, const Vectors& force,
                                        Numbers<k...>) {
        ((Point::load(forces + at.in_block[k]) + force[k]).store(forces + at.in_block[k]), ...);
    }
    static EIGEN_ALWAYS_INLINE Vectors transposed(Vectors v) {
        Point::transpose(v[0], v[1], v[2], v[3]);
        return v;
    }
    /// The lanes of one register in vectors that are transposed.
    static EIGEN_ALWAYS_INLINE network_detail::Axes<Part> part(const Vectors& v, int n) {
        return {v[0].part[n], v[1].part[n], v[2].part[n]};
    }
    /// Back to points: parts of all x, of all y, of all z.
    template <int... n>
    static EIGEN_ALWAYS_INLINE Vectors
    points(const std::array<network_detail::Axes<Part>, Point::parts>& axes, Numbers<n...>) {
        const Part zero(Scalar(0));
        return transposed({Point{{axes[n][0]...}}, Point{{axes[n][1]...}}, Point{{axes[n][2]...}},
                           Point{{(static_cast<void>(n), zero)...}}});
    }
    template <int... n>
    static EIGEN_ALWAYS_INLINE FlowOfFour flow_past(const WindView<Scalar>& view, const Four& four,
                                                    Numbers<n...>);
    template <int... n>
    static EIGEN_ALWAYS_INLINE void add_four(const WindView<Scalar>& view, const Four& four,
                                             const FlowOfFour& flow, Numbers<n...>);

    std::vector<Four> fours_;       // tile by tile
    std::vector<std::size_t> end_;  // of each tile
};

template <class Scalar>
auto TriangleFours<Scalar>::places(const std::array<TrianglePair, 4>& pairs, const Blocks& blocks,
                                   int block) -> Four {
    Four result;
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t i = 0; i < 4; ++i) {
            const int place = pairs[k].corner[i];
            const bool inside = blocks.of(place) == block;
            result[i].in_planes[k] = 4 * static_cast<std::uint32_t>(place);
            result[i].in_block[k] = static_cast<std::uint16_t>(
                4 * (inside ? place - blocks.begin(block) : blocks.size()));
        }
    }
    return result;
}

template <class Scalar>
TriangleFours<Scalar>::TriangleFours(const std::vector<TrianglePair>& pairs, const Blocks& blocks) {
    std::vector<std::vector<TrianglePair>> of_tile(static_cast<std::size_t>(blocks.tiles()));
    for (const auto& pair : pairs) {
        std::vector<int> in_tiles;
        pair.add_tiles(blocks, in_tiles);
        for (const int tile : first_of_blocks(std::move(in_tiles), blocks))
            detail::at(of_tile, tile).push_back(pair);
    }
    for (int tile = 0; tile < blocks.tiles(); ++tile) {
        auto& here = detail::at(of_tile, tile);
        std::sort(here.begin(), here.end(),
                  [](const auto& s, const auto& t) { return s.corner < t.corner; });
        for (std::size_t first = 0; first < here.size(); first += 4) {
            const int a = here[first].corner[0];
            std::array<TrianglePair, 4> four;
            four.fill({{a, a, a, a}});
            std::copy_n(&here[first], std::min<std::size_t>(4, here.size() - first), four.begin());
            fours_.push_back(places(four, blocks, blocks.block_of_tile(tile)));
        }
        end_.push_back(fours_.size());
    }
}

template <class Scalar>
template <int... n>
EIGEN_ALWAYS_INLINE auto TriangleFours<Scalar>::flow_past(const WindView<Scalar>& view,
                                                          const Four& four, Numbers<n...>)
    -> FlowOfFour {
    const Scalar* x = view.at.first;
    const Scalar* v = view.v.first;
    const auto& [a, b, c, d] = four;
    const Vectors at_b = load(x, b, all);
    const Vectors x_ab = transposed(minus(at_b, load(x, a, all), all));
    const Vectors x_bc = transposed(minus(load(x, c, all), at_b, all));
    const Vectors x_bd = transposed(minus(load(x, d, all), at_b, all));
    const Vectors v_a = transposed(load(v, a, all));
    const Vectors v_bc = transposed(plus(load(v, b, all), load(v, c, all), all));
    const Vectors v_d = transposed(load(v, d, all));
    return {flow_past_pair<Part>(view.air, part(x_ab, n), part(x_bc, n), part(x_bd, n),
                                 part(v_a, n), part(v_bc, n), part(v_d, n))...};
}

template <class Scalar>
template <int... n>
EIGEN_ALWAYS_INLINE void TriangleFours<Scalar>::add_four(const WindView<Scalar>& view,
                                                         const Four& four, const FlowOfFour& flow,
                                                         Numbers<n...> parts) {
    const Vectors on_a = points({flow[n].at_a.on_corner(view.air.factors)...}, parts);
    const Vectors on_d = points({flow[n].at_d.on_corner(view.air.factors)...}, parts);
    const Vectors on_both = plus(on_a, on_d, all);
    Scalar* forces = view.force_a.first;
    add(forces, four[0], on_a, all);
    add(forces, four[1], on_both, all);
    add(forces, four[2], on_both, all);
    add(forces, four[3], on_d, all);
}

}  // namespace taut::step_detail
