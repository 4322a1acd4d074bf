// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "../core/buffer.hpp"
#include "../core/types.hpp"
#include "../network/damping.hpp"

namespace taut::step_detail {

/// One vector a place, as Dim planes: plane d begins d·stride scalars after the first.
template <class Scalar>
struct Planes {
    Scalar* first = nullptr;
    Index stride = 0;
    Scalar* operator[](int d) const { return first + d * stride; }
    Planes at(Index place) const { return {first + place, stride}; }
};

/// visit(d) for each of the coordinates, unrolled whatever the compiler's flags.
template <int Dim, class Visitor>
EIGEN_ALWAYS_INLINE void for_each_axis(Visitor&& visit) {
    visit(0);
    if constexpr (Dim > 1) visit(1);
    if constexpr (Dim > 2) visit(2);
}

/// Places of a tile: its planes of positions, velocities and forces stay in the first cache.
inline constexpr int tile_size = 256;
/// Most places of a block.
inline constexpr int most_of_block = 2048;

/// How places are divided: into blocks of one size, and these into tiles. By the number of places
/// alone, so that the order of all sums is the same for any number of threads.
class Blocks {
public:
    Blocks() = default;
    explicit Blocks(Index places) : places_(static_cast<int>(places)) {
        int count = divided(places_, most_of_block);
        // Two threads have the same to do.
        if (count > 1) count += count % 2;
        if (count > 0) size_ = divided(divided(places_, count), tile_size) * tile_size;
    }
    int places() const { return places_; }
    /// Places of a block; the last one may have fewer.
    int size() const { return size_; }
    int count() const { return divided(places_, size_); }
    int tiles() const { return divided(places_, tile_size); }

    /// The block of a place.
    int of(int place) const { return place / size_; }
    /// The first place of a block.
    int begin(int block) const { return block * size_; }
    int first_tile(int block) const { return begin(block) / tile_size; }
    int block_of_tile(int tile) const { return tile * tile_size / size_; }

    /// How many of so many threads shorten a step: fewer would have more blocks each.
    int workers(int threads) const {
        const int most = (std::max)(1, (std::min)(threads, count()));
        return divided(count(), (std::max)(1, divided(count(), most)));
    }

private:
    /// Rounded up.
    static int divided(int number, int by) { return (number + by - 1) / by; }

    int places_ = 0;
    int size_ = most_of_block;
};

/// Where particles are, for a plan of forces beside the springs'.
struct PlacedParticles {
    const Buffer<int>& place;  // of each particle
    const Blocks& blocks;
    bool points;  // whether a plane holds points, x y z 0
};

/// What a force beside the springs' knows before a step.
template <class Scalar>
class TilePlan {
public:
    virtual ~TilePlan() = default;
    /// The most blocks between places that such a force ties together.
    int reach() const { return reach_; }

protected:
    int reach_ = 0;
};

/// What springs and other forces of one tile read and write.
template <class Scalar>
struct TileView {
    Planes<const Scalar> x;   // m, of all places, as springs see them
    Planes<const Scalar> v;   // m/s, of all places
    Planes<const Scalar> at;  // m, of all places, as they are
    Scalar alpha;             // of Rayleigh damping, s
    int begin;                // the block's first place
    int size;                 // places of a block
    int tile;                 // among those of all blocks
    /// Forces on the places of the block, N: those on ends a and those on ends b. Apart, because a
    /// register stored to one address and loaded from the next would wait for the store. Stars' are
    /// all in the first.
    Planes<Scalar> force_a;
    Planes<Scalar> force_b;
    /// For forces on places of other blocks. Its numbers are never used.
    Planes<Scalar> discard;
};

}  // namespace taut::step_detail
