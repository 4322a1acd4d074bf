// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>

#include "quad.hpp"
#include "stars.hpp"

namespace taut::step_detail {

/// The springs and gaps first_a … first_a + count − 1 of one run.
struct Segment {
    int run;
    int first_a;  // this and count are multiples of the register's width
    int count;
    bool writes_a;  // whether the ends a lie in the tile's block
    bool writes_b;  // whether an end b does
};

/// The runs of one law's springs, cut into segments.
struct PlannedRuns {
    struct Run {
        int first_a;  // of its first spring or gap
        int offset;   // b − a
        int count;    // of its springs and gaps
    };
    Buffer<Run> runs;
    Buffer<Segment> segments;  // tile by tile
    Buffer<int> segment_end;   // of each tile
};

/// A batch touches so many places at most: as many copies stay in the first cache.
inline constexpr int most_gathered = 512;

/// Which springs and which gathered places of all batches are one batch.
struct Batch {
    int first_spring;
    int springs;
    int first_gathered;
    int gathered;
};

/// The scattered springs of one law, in batches.
struct PlannedBatches {
    /// The ends of a spring, among the gathered places of its batch.
    struct Ends {
        std::uint16_t a, b;
    };
    Buffer<Batch> batches;  // tile by tile
    Buffer<int> batch_end;  // of each tile
    Buffer<Ends> ends;      // of the springs, batch by batch
    Buffer<int> gathered;   // places, batch by batch
};

/// An order of n particles that brings the ends of springs close together (Cuthill and McKee, 1969,
/// reversed): particle order[p] of the system goes to place p.
TAUT_COLD Buffer<int> cache_order(int n, const Buffer<SpringEnds>& laws);

/// The springs of a system as a sweep takes them.
struct SpringOrder {
    std::unique_ptr<SortedSprings[]> laws;  // the springs of each
    Buffer<int> order;   // the particle at each place; empty: particle i at place i
    int reach = 0;       // the most blocks between the ends of a spring
    bool stars = false;  // whether all springs are in stars
};

/// The width that plans fit, as do all that are narrower.
#if defined(TAUT_COMPILED)  // the widest that the library may take
int planned_width(float);
int planned_width(double);
#endif
template <class Scalar>
constexpr int planned_width(Scalar) {
    return VectorRegister<Scalar>::width;
}

/// Plans that depend on indices and on the width of registers: the same for all laws and
/// dimensions, and so compiled once.
template <class Scalar>
struct Planner {
    using Register = VectorRegister<Scalar>;
    /// Never wider than 32 bytes, like points: beside wider ones Intel's processors add on two
    /// ports instead of three.
    using StarRegister = std::conditional_t<sizeof(Scalar) == 4 && Register::width >= 8,
                                            VectorRegister<Scalar, 8>, typename Quad<Scalar>::Part>;
    /// So many stars fill whole registers.
    static constexpr int group =
        StarRegister::width > star_size ? StarRegister::width / star_size : 1;

    TAUT_COLD static SpringOrder order(const Buffer<SpringEnds>& laws, const Blocks& blocks,
                                       bool may_have_stars);
    /// @param index  of these three: gets the springs and gaps that are computed, in their order
    TAUT_COLD static PlannedRuns runs(const SortedSprings& springs, const Blocks& blocks,
                                      Buffer<int>& index);
    TAUT_COLD static PlannedBatches batches(const SortedSprings& springs, const Blocks& blocks,
                                            Buffer<int>& index);
    TAUT_COLD static StarGroups groups(const SortedSprings& springs, const Blocks& blocks,
                                       Buffer<int>& index);
};

}  // namespace taut::step_detail

#if !defined(TAUT_COMPILED)
#include "planner-inl.hpp"
#endif
