// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "../../core/types.hpp"
#include "spring_runs.hpp"
#include "spring_values.hpp"

namespace taut::detail {

/// The particles of a sweep come in blocks of this many, whatever the number of threads. A spring
/// between two blocks is evaluated in both, so that each block writes to its own particles only.
inline constexpr int block_size = 2048;
/// A block is swept in tiles of this many particles, in order: springs begin in a tile, and end
/// there or in a later one, so the forces on a tile are complete while they are in the first cache.
inline constexpr int tile_size = 256;

/// Plane d of one vector a particle: d·stride scalars after the first plane.
template <class Scalar>
struct Planes {
    Scalar* first = nullptr;
    Index stride = 0;
    Scalar* operator[](int d) const { return first + d * stride; }
    Planes at(Index i) const { return {first + i, stride}; }
};

/// What damping in proportion to stiffness a sweep computes; `projected` includes `graph`.
enum class Proportional { none, graph, projected };

/// What a sweep over the springs of one block reads and writes.
template <class Scalar>
struct BlockSweep {
    Planes<const Scalar> x;  // m, of all particles
    Planes<const Scalar> v;  // m/s
    StiffnessDamping<Scalar> damping;
    int block;
    int tile;  // of all tiles
    /// Forces on the block's particles, N; where springs begin and where they end. Apart, because
    /// a register stored to one place and loaded from the next would wait for the store.
    Planes<Scalar> begin_force;
    Planes<Scalar> end_force;
    Planes<Scalar> foreign_force;  // on particles of other blocks: written, never read
};

/// The springs of one law in the order of a sweep: runs of one offset b − a and consecutive a,
/// which need no index and no gather, and lists of the others.
template <class Scalar, int Dim, class Law>
class SpringPlan {
    using Pack = Lanes<Scalar>;
    using Values = SpringValues<Scalar, Law>;
    using Cursor = typename Values::Cursor;
    static constexpr int width = Pack::size;

public:
    using Set = SpringSet<Scalar, Law>;

    SpringPlan() = default;
    SpringPlan(const Set& set, const SpringRuns& springs, int tiles);

    bool damped() const { return damped_; }
    /// Adds the forces of the sweep's tile on the particles of its block.
    template <Proportional Kind>
    void add_forces(const BlockSweep<Scalar>& sweep) const {
        damped_ ? add_forces<true, Kind>(sweep) : add_forces<false, Kind>(sweep);
    }

private:
    /// Springs a … a + count − 1 of one run, of which some begin in the block, or end in it, or
    /// both.
    struct Segment {
        int run;
        int a;  // these are multiples of the register's width
        int count;
        bool begins;
        bool ends;
    };
    struct Run {
        int a;       // of the first of its values
        int offset;  // b − a
        typename Values::Slice values;
    };
    /// Springs by their ends among the particles that the list touches.
    struct List {
        std::size_t first;
        int count = 0;
        std::size_t first_touched;
        int touched = 0;
        typename Values::Slice values{};
    };
    struct Ends {
        std::uint16_t a, b;
    };
    /// Where a segment begins in the planes.
    struct Lane {
        Planes<const Scalar> x_begin, x_end;
        Planes<const Scalar> v_begin, v_end;
        Planes<Scalar> begin_force, end_force;
    };
    using Vectors = std::array<Pack, Dim>;
    struct Pull {
        Pack A, B;
    };
    /// One vector, in memory as registers like it.
    using Point = Eigen::Array<Scalar, Dim == 3 ? 4 : Dim, 1>;
    /// A list works on copies of as many particles, in the first cache.
    static constexpr int most_touched = 512;

    static EIGEN_ALWAYS_INLINE Pack dot(const Vectors& a, const Vectors& b) {
        Pack sum = a[0] * b[0];
        if constexpr (Dim > 1) sum += a[1] * b[1];
        if constexpr (Dim > 2) sum += a[2] * b[2];
        return sum;
    }
    void add_run(const Set& set, const SpringRuns& springs, const SpringRuns::Run& run,
                 std::vector<std::vector<Segment>>& segments);
    using Springs = std::vector<NumberedSpring>::const_iterator;
    Springs add_list(const Set& set, Springs next, Springs end);
    void add_rest(const Set& set, const std::vector<NumberedSpring>& rest, int tiles);

    template <bool Dampers, Proportional Kind>
    void add_forces(const BlockSweep<Scalar>& sweep) const;
    template <bool Dampers, Proportional Kind>
    void add_segment(const BlockSweep<Scalar>& sweep, const Segment& segment) const;
    template <bool Dampers, Proportional Kind>
    void add_list(const BlockSweep<Scalar>& sweep, const List& list) const;
    template <bool Dampers, Proportional Kind>
    EIGEN_ALWAYS_INLINE Pull pull(const Cursor& springs, const StiffnessDamping<Scalar>& by,
                                  const Pack& l2, const Pack& s) const;

    std::vector<Run> runs_;
    std::vector<Segment> segments_;         // tile by tile
    std::vector<std::size_t> segment_end_;  // of each tile
    std::vector<List> lists_;               // tile by tile
    std::vector<std::size_t> list_end_;     // of each tile
    std::vector<Ends> ends_;                // of the lists' springs
    std::vector<int> touched_;              // particles of the lists
    Values values_;
    bool damped_ = false;
};

template <class Scalar, int Dim, class Law>
SpringPlan<Scalar, Dim, Law>::SpringPlan(const Set& set, const SpringRuns& springs, int tiles)
    : damped_(!set.damping.empty()) {
    std::vector<std::vector<Segment>> segments(tiles);
    for (const auto& run : springs.runs()) add_run(set, springs, run, segments);
    for (const auto& tile : segments) {
        segments_.insert(segments_.end(), tile.begin(), tile.end());
        segment_end_.push_back(segments_.size());
    }
    add_rest(set, springs.rest(), tiles);
    values_.finish();
}

template <class Scalar, int Dim, class Law>
void SpringPlan<Scalar, Dim, Law>::add_run(const Set& set, const SpringRuns& springs,
                                           const SpringRuns::Run& run,
                                           std::vector<std::vector<Segment>>& segments) {
    const int begin = springs.spring(run.first).a / width * width;
    const int end = (springs.spring(run.last - 1).a / width + 1) * width;
    std::vector<int> index(static_cast<std::size_t>(end - begin));
    std::size_t next = run.first;
    for (int a = begin; a < end; ++a) {
        const bool there = next < run.last && springs.spring(next).a == a;
        const int neighbour = springs.spring(std::min(next, run.last - 1)).index;
        index[static_cast<std::size_t>(a - begin)] = there ? neighbour : Values::gap(neighbour);
        if (there) ++next;
    }
    const int number = static_cast<int>(runs_.size());
    const int offset = springs.spring(run.first).b - springs.spring(run.first).a;
    runs_.push_back({begin, offset, values_.add(set, index)});
    const auto append = [&](int tile, const Segment& segment) {
        if (tile >= static_cast<int>(segments.size())) return;  // gaps beyond the last particle
        auto& list = segments[tile];
        if (!list.empty() && list.back().run == number && list.back().begins == segment.begins &&
            list.back().ends == segment.ends && list.back().a + list.back().count == segment.a) {
            list.back().count += width;
        } else {
            list.push_back(segment);
        }
    };
    for (int a = begin; a < end; a += width) {
        const int block = a / block_size;
        const int first_end = (a + offset) / block_size;
        const int last_end = (a + offset + width - 1) / block_size;
        append(a / tile_size, {number, a, width, true, block == first_end});
        // Springs that come from an earlier block go with the first tile of this one.
        constexpr int tiles = block_size / tile_size;
        if (first_end != block) append(first_end * tiles, {number, a, width, false, true});
        if (last_end != first_end) append(last_end * tiles, {number, a, width, false, true});
    }
}

template <class Scalar, int Dim, class Law>
void SpringPlan<Scalar, Dim, Law>::add_rest(const Set& set, const std::vector<NumberedSpring>& rest,
                                            int tiles) {
    std::vector<std::vector<NumberedSpring>> springs(tiles);
    for (const auto& spring : rest) {
        const int end_block = spring.b / block_size;
        springs[spring.a / tile_size].push_back(spring);
        if (end_block != spring.a / block_size) {
            springs[end_block * (block_size / tile_size)].push_back(spring);
        }
    }
    for (auto& tile : springs) {
        spread(tile);
        for (auto next = tile.cbegin(); next != tile.cend();)
            next = add_list(set, next, tile.cend());
        list_end_.push_back(lists_.size());
    }
}

/// A list of as many springs as touch few enough particles. @returns the first of the others
template <class Scalar, int Dim, class Law>
auto SpringPlan<Scalar, Dim, Law>::add_list(const Set& set, Springs next, Springs end) -> Springs {
    List list{ends_.size(), 0, touched_.size()};
    std::unordered_map<int, std::uint16_t> place;
    const auto touch = [&](int particle) {
        const auto [at, is_new] =
            place.try_emplace(particle, static_cast<std::uint16_t>(place.size()));
        if (is_new) touched_.push_back(particle);
        return at->second;
    };
    std::vector<int> index;
    for (; next != end && place.size() + 2 <= most_touched; ++next) {
        const auto a = touch(next->a);
        ends_.push_back({a, touch(next->b)});
        index.push_back(next->index);
    }
    list.count = static_cast<int>(index.size());
    list.touched = static_cast<int>(place.size());
    list.values = values_.add(set, index);
    lists_.push_back(list);
    return next;
}

template <class Scalar, int Dim, class Law>
template <bool Dampers, Proportional Kind>
void SpringPlan<Scalar, Dim, Law>::add_forces(const BlockSweep<Scalar>& sweep) const {
    const auto tile = static_cast<std::size_t>(sweep.tile);
    for (std::size_t s = tile == 0 ? 0 : segment_end_[tile - 1]; s < segment_end_[tile]; ++s) {
        add_segment<Dampers, Kind>(sweep, segments_[s]);
    }
    for (std::size_t s = tile == 0 ? 0 : list_end_[tile - 1]; s < list_end_[tile]; ++s) {
        add_list<Dampers, Kind>(sweep, lists_[s]);
    }
}

/// The force on the end a of each spring is A·dx + B·dv; l2 = dx·dx, s = dx·dv.
template <class Scalar, int Dim, class Law>
template <bool Dampers, Proportional Kind>
EIGEN_ALWAYS_INLINE auto SpringPlan<Scalar, Dim, Law>::pull(const Cursor& springs,
                                                            const StiffnessDamping<Scalar>& by,
                                                            const Pack& l2, const Pack& s) const
    -> Pull {
    // Kept from zero, a spring of no length has no direction, and so no force.
    const Pack safe_l2 = max(l2, Pack(std::numeric_limits<Scalar>::min()));
    const Pack over_l = reciprocal_sqrt(safe_l2);
    const Pack l = safe_l2 * over_l;
    const Pack tension = springs.evaluate(
        [](const auto& p, auto L, auto length) { return Law::tension(p, L, length); }, l);
    const Pack tension_over_l = tension * over_l;
    const Pack zero(Scalar(0));
    if constexpr (!Dampers && Kind == Proportional::none)
        return {springs.unless_gap(tension_over_l), zero};
    Pack A = tension_over_l;
    Pack B = zero;
    Pack bound = zero;
    if constexpr (Kind != Proportional::none) {
        bound = springs.evaluate([](const auto& p, auto L) { return Law::stiffness_bound(p, L); });
        B = Pack(by.graph) * bound;
    }
    [[maybe_unused]] const Pack stretching = s * over_l * over_l;
    if constexpr (Dampers) A += springs.damping() * stretching;
    if constexpr (Kind == Proportional::projected) {
        const Pack slope = springs.evaluate(
            [](const auto& p, auto L, auto length) { return Law::tension_slope(p, L, length); }, l);
        const Pack transverse = where_less(zero, l2, max(tension_over_l, zero), bound);
        B += Pack(by.projected) * transverse;
        A += Pack(by.projected) * (max(slope, zero) - transverse) * stretching;
    }
    return {springs.unless_gap(A), springs.unless_gap(B)};
}

template <class Scalar, int Dim, class Law>
template <bool Dampers, Proportional Kind>
void SpringPlan<Scalar, Dim, Law>::add_segment(const BlockSweep<Scalar>& sweep,
                                               const Segment& segment) const {
    const Run& run = runs_[segment.run];
    const int first = sweep.block * block_size;
    const Lane at{
        sweep.x.at(segment.a),
        sweep.x.at(segment.a + run.offset),
        sweep.v.at(segment.a),
        sweep.v.at(segment.a + run.offset),
        segment.begins ? sweep.begin_force.at(segment.a - first) : sweep.foreign_force,
        segment.ends ? sweep.end_force.at(segment.a + run.offset - first) : sweep.foreign_force};
    Cursor springs(values_, run.values, static_cast<std::size_t>(segment.a - run.a));
    for (int i = 0; i < segment.count; i += width, springs.next()) {
        Vectors dx, dv;
        for_each_axis<Dim>([&](int d) {
            dx[d] = Pack::load(at.x_end[d] + i) - Pack::load(at.x_begin[d] + i);
            if constexpr (Dampers || Kind != Proportional::none) {
                dv[d] = Pack::load(at.v_end[d] + i) - Pack::load(at.v_begin[d] + i);
            }
        });
        Pack s(Scalar(0));
        if constexpr (Dampers || Kind == Proportional::projected) s = dot(dx, dv);
        const Pull pull_on_a = pull<Dampers, Kind>(springs, sweep.damping, dot(dx, dx), s);
        for_each_axis<Dim>([&](int d) {
            Pack force = pull_on_a.A * dx[d];
            if constexpr (Kind != Proportional::none) force += pull_on_a.B * dv[d];
            Scalar* begin_force = at.begin_force[d] + i;
            Scalar* end_force = at.end_force[d] + i;
            (Pack::load(begin_force) + force).store(begin_force);
            (Pack::load(end_force) - force).store(end_force);
        });
    }
}

template <class Scalar, int Dim, class Law>
template <bool Dampers, Proportional Kind>
void SpringPlan<Scalar, Dim, Law>::add_list(const BlockSweep<Scalar>& sweep,
                                            const List& list) const {
    constexpr bool velocities = Dampers || Kind != Proportional::none;
    constexpr int chunk = 64;  // springs between the differences and the forces
    static_assert(chunk % most_lanes == 0);
    alignas(64) Point x[most_touched];
    alignas(64) Point v[velocities ? most_touched : 1];
    alignas(64) Point f[most_touched];
    const int* touched = touched_.data() + list.first_touched;
    for (int t = 0; t < list.touched; ++t) {
        x[t].setZero();
        f[t].setZero();
        for (int d = 0; d < Dim; ++d) x[t][d] = sweep.x[d][touched[t]];
        if constexpr (velocities) {
            v[t].setZero();
            for (int d = 0; d < Dim; ++d) v[t][d] = sweep.v[d][touched[t]];
        }
    }
    alignas(64) Point dx[chunk];
    alignas(64) Point dv[velocities ? chunk : 1];
    alignas(64) Scalar l2[chunk] = {};
    alignas(64) Scalar dx_dv[chunk] = {};
    Cursor springs(values_, list.values, 0);
    for (int done = 0; done < list.count; done += chunk) {
        const Ends* ends = ends_.data() + list.first + done;
        const int count = std::min(chunk, list.count - done);
        for (int s = 0; s < count; ++s) {
            dx[s] = x[ends[s].b] - x[ends[s].a];
            l2[s] = dx[s].square().sum();
            if constexpr (velocities) {
                dv[s] = v[ends[s].b] - v[ends[s].a];
                dx_dv[s] = (dx[s] * dv[s]).sum();
            }
        }
        for (int s = 0; s < count; s += width, springs.next()) {
            const Pull pull_on_a = pull<Dampers, Kind>(springs, sweep.damping, Pack::load(l2 + s),
                                                       Pack::load(dx_dv + s));
            pull_on_a.A.store(l2 + s);
            pull_on_a.B.store(dx_dv + s);
        }
        for (int s = 0; s < count; ++s) {
            Point force = l2[s] * dx[s];
            if constexpr (Kind != Proportional::none) force += dx_dv[s] * dv[s];
            f[ends[s].a] += force;
            f[ends[s].b] -= force;
        }
    }
    const int first = sweep.block * block_size;
    for (int t = 0; t < list.touched; ++t) {
        const int i = touched[t] - first;
        if (i < 0 || i >= block_size) continue;  // another block sees to it
        for (int d = 0; d < Dim; ++d) sweep.begin_force[d][i] += f[t][d];
    }
}

}  // namespace taut::detail
