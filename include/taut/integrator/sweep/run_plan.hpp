// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "sorted_springs.hpp"
#include "spring_table.hpp"
#include "tile.hpp"

namespace taut::integrator_detail::sweep {

/// The runs of one law's springs, cut into segments, and the forces of these.
template <class Scalar, int Dim, class Law>
class RunPlan {
    using Set = SpringSet<Scalar, Law>;
    using Table = SpringTable<Scalar, Law>;
    using Register = VectorRegister<Scalar>;
    static constexpr int width = Register::width;

public:
    RunPlan() = default;
    /// @param table  takes the springs' values
    RunPlan(const Set& set, const std::vector<SortedSprings::Run>& runs, const Blocks& blocks,
            Table& table);

    /// Adds the forces of the tile's segments.
    /// @tparam Both  whether a spring takes its positions ahead and as they are [T42]
    template <bool Dampers, bool Rayleigh, bool Both>
    void add_forces(const Table& table, const TileView<Scalar>& view) const {
        const auto tile = static_cast<std::size_t>(view.tile);
        for (std::size_t s = tile == 0 ? 0 : segment_end_[tile - 1]; s < segment_end_[tile]; ++s) {
            add_segment<Dampers, Rayleigh, Both>(table, view, segments_[s]);
        }
    }

private:
    /// What a step needs to know of a run.
    struct Run {
        int first_a;  // of its first spring or gap
        int offset;   // b − a
        typename Table::Columns columns;
    };
    /// The springs and gaps first_a … first_a + count − 1 of one run.
    struct Segment {
        int run;
        int first_a;  // this and count are multiples of the register's width
        int count;
        bool writes_a;  // whether the ends a lie in the tile's block
        bool writes_b;  // whether an end b does
    };
    using Vector = std::array<Register, Dim>;

    static EIGEN_ALWAYS_INLINE Register dot(const Vector& a, const Vector& b) {
        Register sum = a[0] * b[0];
        if constexpr (Dim > 1) sum += a[1] * b[1];
        if constexpr (Dim > 2) sum += a[2] * b[2];
        return sum;
    }
    void add_run(const Set& set, const SortedSprings::Run& run, const Blocks& blocks, Table& table,
                 std::vector<std::vector<Segment>>& segments);
    template <bool Dampers, bool Rayleigh, bool Both>
    void add_segment(const Table& table, const TileView<Scalar>& view,
                     const Segment& segment) const;

    std::vector<Run> runs_;
    std::vector<Segment> segments_;         // tile by tile
    std::vector<std::size_t> segment_end_;  // of each tile
};

template <class Scalar, int Dim, class Law>
RunPlan<Scalar, Dim, Law>::RunPlan(const Set& set, const std::vector<SortedSprings::Run>& runs,
                                   const Blocks& blocks, Table& table) {
    std::vector<std::vector<Segment>> segments(static_cast<std::size_t>(blocks.tiles()));
    for (const auto& run : runs) add_run(set, run, blocks, table, segments);
    for (const auto& of_tile : segments) {
        segments_.insert(segments_.end(), of_tile.begin(), of_tile.end());
        segment_end_.push_back(segments_.size());
    }
}

template <class Scalar, int Dim, class Law>
void RunPlan<Scalar, Dim, Law>::add_run(const Set& set, const SortedSprings::Run& run,
                                        const Blocks& blocks, Table& table,
                                        std::vector<std::vector<Segment>>& segments) {
    const int begin = run.front().a / width * width;
    const int end = (run.back().a / width + 1) * width;
    std::vector<int> index(static_cast<std::size_t>(end - begin));
    auto next = run.begin;
    for (int a = begin; a < end; ++a) {
        const int neighbour = next == run.end ? run.back().index : next->index;
        const bool there = next != run.end && next->a == a;
        index[static_cast<std::size_t>(a - begin)] = there ? neighbour : Table::gap(neighbour);
        if (there) ++next;
    }
    const int number = static_cast<int>(runs_.size());
    const int offset = run.front().offset();
    runs_.push_back({begin, offset, table.add(set, index)});
    const auto append = [&](int tile, const Segment& segment) {
        if (tile >= static_cast<int>(segments.size())) return;  // gaps beyond the last place
        auto& of_tile = segments[tile];
        if (!of_tile.empty() && of_tile.back().run == number &&
            of_tile.back().writes_a == segment.writes_a &&
            of_tile.back().writes_b == segment.writes_b &&
            of_tile.back().first_a + of_tile.back().count == segment.first_a) {
            of_tile.back().count += width;
        } else {
            of_tile.push_back(segment);
        }
    };
    for (int a = begin; a < end; a += width) {
        const int block = blocks.of(a);
        const int first_block_of_b = blocks.of(a + offset);
        const int last_block_of_b = blocks.of(a + offset + width - 1);
        append(a / tile_size, {number, a, width, true, block == first_block_of_b});
        // Springs that come from an earlier block go with the first tile of this one.
        if (first_block_of_b != block) {
            append(blocks.first_tile(first_block_of_b), {number, a, width, false, true});
        }
        if (last_block_of_b != first_block_of_b) {
            append(blocks.first_tile(last_block_of_b), {number, a, width, false, true});
        }
    }
}

template <class Scalar, int Dim, class Law>
template <bool Dampers, bool Rayleigh, bool Both>
void RunPlan<Scalar, Dim, Law>::add_segment(const Table& table, const TileView<Scalar>& view,
                                            const Segment& segment) const {
    const Run& run = runs_[segment.run];
    const int first_a = segment.first_a;
    const int first_b = first_a + run.offset;
    const Planes<const Scalar> x_a = view.x.at(first_a);
    const Planes<const Scalar> x_b = view.x.at(first_b);
    [[maybe_unused]] const Planes<const Scalar> here_a = view.at.at(first_a);
    [[maybe_unused]] const Planes<const Scalar> here_b = view.at.at(first_b);
    const Planes<const Scalar> v_a = view.v.at(first_a);
    const Planes<const Scalar> v_b = view.v.at(first_b);
    const Planes<Scalar> force_a =
        segment.writes_a ? view.force_a.at(first_a - view.begin) : view.discard;
    const Planes<Scalar> force_b =
        segment.writes_b ? view.force_b.at(first_b - view.begin) : view.discard;
    typename Table::Reader springs(table, run.columns,
                                   static_cast<std::size_t>(first_a - run.first_a));
    for (int i = 0; i < segment.count; i += width, springs.next()) {
        Vector dx, dv;
        [[maybe_unused]] Vector here;
        for_each_axis<Dim>([&](int d) {
            dx[d] = Register::load(x_b[d] + i) - Register::load(x_a[d] + i);
            if constexpr (Dampers || Rayleigh) {
                dv[d] = Register::load(v_b[d] + i) - Register::load(v_a[d] + i);
            }
            if constexpr (Both) {
                here[d] = Register::load(here_b[d] + i) - Register::load(here_a[d] + i);
            }
        });
        Register dx_dv(Scalar(0));
        if constexpr (Dampers || Rayleigh) dx_dv = dot(dx, dv);
        const auto pull = [&] {
            if constexpr (Both) {
                return springs.template pull_ahead<Dampers, Rayleigh>(view.alpha, dot(dx, dx),
                                                                      dx_dv, dot(here, here));
            } else {
                return springs.template pull<Dampers, Rayleigh>(view.alpha, dot(dx, dx), dx_dv);
            }
        }();
        for_each_axis<Dim>([&](int d) {
            Register force = pull.of_dx * dx[d];
            if constexpr (Both) force -= pull.of_here * here[d];
            if constexpr (Rayleigh) force += pull.of_dv * dv[d];
            Scalar* on_a = force_a[d] + i;
            Scalar* on_b = force_b[d] + i;
            (Register::load(on_a) + force).store(on_a);
            (Register::load(on_b) - force).store(on_b);
        });
    }
}

}  // namespace taut::integrator_detail::sweep
