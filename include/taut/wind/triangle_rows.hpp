// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <tuple>
#include <vector>

#include "../step/register.hpp"
#include "../step/tile.hpp"
#include "triangles.hpp"

namespace taut::step_detail {

/// Pairs of triangles whose corners lie side by side in planes, as many as a register has lanes: a
/// row, as in a grid. A pair without neighbours is a row of its own.
template <class Scalar>
class TriangleRows {
    using Register = VectorRegister<Scalar>;
    static constexpr int width = Register::width;

public:
    TriangleRows() = default;
    TriangleRows(std::vector<TrianglePair> pairs, const Blocks& blocks);

    /// Adds the forces of the wind on the tile's rows.
    void add_forces(const WindView<Scalar>& view) const {
        const auto tile = static_cast<std::size_t>(view.tile);
        const std::size_t first = tile == 0 ? 0 : end_[tile - 1];
        for (std::size_t r = first; r < end_[tile]; ++r)
            add_row(view, rows_[r], flow_past(view, rows_[r]));
    }

private:
    struct Row {
        std::array<int, 4> first;  // corners of the first lane
        int lanes;                 // where lanes_ says which lanes have a pair; −1: all
    };
    using Vector = network_detail::Axes<Register>;

    static EIGEN_ALWAYS_INLINE Vector load(const Planes<const Scalar>& planes, int place) {
        const auto at = planes.at(place);
        return {Register::load(at[0]), Register::load(at[1]), Register::load(at[2])};
    }
    static EIGEN_ALWAYS_INLINE Vector minus(const Vector& a, const Vector& b) {
        return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    }
    static EIGEN_ALWAYS_INLINE void keep(const Register& lanes, Vector& force) {
        for_each_axis<3>([&](int d) { force[d] = unless_negative(lanes, force[d]); });
    }
    static EIGEN_ALWAYS_INLINE void add(const WindView<Scalar>& view, const Planes<Scalar>& forces,
                                        int first, const Vector& force) {
        const int place = first - view.begin;
        const bool inside = place > -width && place < view.size;
        const auto to = inside ? forces.at(place) : view.discard;
        for_each_axis<3>([&](int d) { (Register::load(to[d]) + force[d]).store(to[d]); });
    }
    static EIGEN_ALWAYS_INLINE PairFlow<Register> flow_past(const WindView<Scalar>& view,
                                                            const Row& row);
    EIGEN_ALWAYS_INLINE void add_row(const WindView<Scalar>& view, const Row& row,
                                     const PairFlow<Register>& flow) const;

    std::vector<Row> rows_;         // tile by tile
    std::vector<std::size_t> end_;  // of each tile
    std::vector<Scalar> lanes_;     // ≥ 0 where there is a pair, a register for each kind of row
};

template <class Scalar>
TriangleRows<Scalar>::TriangleRows(std::vector<TrianglePair> pairs, const Blocks& blocks) {
    const auto key = [](const TrianglePair& pair) {
        const auto& [a, b, c, d] = pair.corner;
        return std::tuple(b - a, c - a, d - a, pair.lowest() / width * width);
    };
    const auto lane = [](const TrianglePair& pair) { return pair.lowest() % width; };
    std::sort(pairs.begin(), pairs.end(), [&](const auto& s, const auto& t) {
        return std::tuple(key(s), lane(s)) < std::tuple(key(t), lane(t));
    });
    std::vector<std::vector<Row>> rows(static_cast<std::size_t>(blocks.tiles()));
    std::map<unsigned, int> known{{(1u << width) - 1, -1}};
    for (auto next = pairs.cbegin(); next != pairs.cend();) {
        const auto first = next;
        unsigned bits = 0;
        std::vector<int> in_tiles;
        for (; next != pairs.cend() && key(*next) == key(*first); ++next) {
            const unsigned bit = 1u << lane(*next);
            if (bits & bit) break;  // the same pair once more
            bits |= bit;
            next->add_tiles(blocks, in_tiles);
        }
        const auto [kind, is_new] = known.try_emplace(bits, static_cast<int>(lanes_.size()));
        for (int i = 0; is_new && i < width; ++i) {
            lanes_.push_back(bits >> i & 1 ? Scalar(1) : Scalar(-1));
        }
        Row row{first->corner, kind->second};
        for (int& corner : row.first) corner -= lane(*first);
        for (const int tile : first_of_blocks(std::move(in_tiles), blocks))
            detail::at(rows, tile).push_back(row);
    }
    for (const auto& of_tile : rows) {
        rows_.insert(rows_.end(), of_tile.begin(), of_tile.end());
        end_.push_back(rows_.size());
    }
}

template <class Scalar>
EIGEN_ALWAYS_INLINE auto TriangleRows<Scalar>::flow_past(const WindView<Scalar>& view,
                                                         const Row& row) -> PairFlow<Register> {
    const auto& [a, b, c, d] = row.first;
    const Planes<const Scalar>& x = view.at;
    const Vector x_b = load(x, b);
    const Vector v_b = load(view.v, b);
    const Vector v_c = load(view.v, c);
    return flow_past_pair<Register>(
        view.air, minus(x_b, load(x, a)), minus(load(x, c), x_b), minus(load(x, d), x_b),
        load(view.v, a), {v_b[0] + v_c[0], v_b[1] + v_c[1], v_b[2] + v_c[2]}, load(view.v, d));
}

template <class Scalar>
EIGEN_ALWAYS_INLINE void TriangleRows<Scalar>::add_row(const WindView<Scalar>& view, const Row& row,
                                                       const PairFlow<Register>& flow) const {
    Vector on_a = flow.at_a.on_corner(view.air.factors);
    Vector on_d = flow.at_d.on_corner(view.air.factors);
    if (row.lanes >= 0) {
        const Register lanes = Register::load(lanes_.data() + row.lanes);
        keep(lanes, on_a);
        keep(lanes, on_d);
    }
    const Vector on_both{on_a[0] + on_d[0], on_a[1] + on_d[1], on_a[2] + on_d[2]};
    const auto& [a, b, c, d] = row.first;
    // Corners next to each other in different planes: see TileView.
    add(view, view.force_a, a, on_a);
    add(view, view.force_b, b, on_both);
    add(view, view.force_a, c, on_both);
    add(view, view.force_b, d, on_d);
}

}  // namespace taut::step_detail
