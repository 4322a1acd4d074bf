// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "../core/buffer.hpp"
#include "register.hpp"

namespace taut::step_detail {

/// Fewer springs of one offset are not worth a run.
inline constexpr int shortest_run = 16;

/// The numbers 0 … count − 1.
TAUT_COLD Buffer<int> numbers(std::size_t count);

/// Sorts items by key[item] ≥ 0; those of one key stay in their order.
TAUT_COLD void sort_by(const Buffer<int>& key, Buffer<int>& items);

/// A spring by the places of its ends, a < b, and its index in the set.
struct PlacedSpring {
    int a;
    int b;
    int index;

    int offset() const { return b - a; }
};

/// Stands for a spring's index: a gap, with parameters of a neighbour that a law can take.
inline int gap(int neighbour) { return -1 - neighbour; }

/// The ends of one law's springs, particles.
struct SpringEnds {
    const int* a;
    const int* b;
    std::size_t count;

    template <class Numbers>
    SpringEnds(const Numbers& of_a, const Numbers& of_b)
        : a(of_a.data()), b(of_b.data()), count(of_a.size()) {}
};

/// The springs of a set sorted into runs, and the scattered ones that fit none.
class SortedSprings {
public:
    /// Springs of one offset and ascending a: which of all.
    struct Run {
        int begin, end;
    };

    /// @param place  of each particle; empty: particle i at place i
    SortedSprings() = default;
    TAUT_COLD explicit SortedSprings(const SpringEnds& ends, const Buffer<int>& place = {});

    /// By offset, then by a, then by index.
    const Buffer<PlacedSpring>& all() const { return springs_; }
    const Buffer<Run>& runs() const { return runs_; }
    /// Which of all, in their order.
    const Buffer<int>& scattered() const { return scattered_; }

private:
    /// A run goes on over a short gap, such as that between the rows of a grid.
    static bool goes_on(const PlacedSpring& last, const PlacedSpring& next) {
        return next.offset() == last.offset() && next.a > last.a && next.a <= last.a + max_width;
    }
    TAUT_COLD void find_runs();

    Buffer<PlacedSpring> springs_;
    Buffer<Run> runs_;
    Buffer<int> scattered_;
};

}  // namespace taut::step_detail
