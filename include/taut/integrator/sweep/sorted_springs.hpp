// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "../../core/buffer.hpp"
#include "register.hpp"

namespace taut::integrator_detail::sweep {

/// Fewer springs of one offset are not worth a run.
inline constexpr int shortest_run = 16;

/// The numbers 0 … count − 1.
TAUT_COLD inline Buffer<int> numbers(std::size_t count) {
    Buffer<int> result(count);
    for (std::size_t i = 0; i < count; ++i) result[i] = static_cast<int>(i);
    return result;
}

/// Sorts items by key[item] ≥ 0; those of one key stay in their order.
TAUT_COLD inline void sort_by(const Buffer<int>& key, Buffer<int>& items) {
    int most = -1;
    for (const int item : items) most = std::max(most, key[item]);
    Buffer<int> next(static_cast<std::size_t>(most) + 2, 0);
    for (const int item : items) ++next[key[item] + 1];
    for (int i = 0; i <= most; ++i) next[i + 1] += next[i];
    Buffer<int> sorted(items.size());
    for (const int item : items) sorted[next[key[item]]++] = item;
    items = std::move(sorted);
}

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
    TAUT_COLD explicit SortedSprings(const SpringEnds& ends, const Buffer<int>& place = {}) {
        const std::size_t count = ends.count;
        Buffer<int> a(count), offset(count);
        for (std::size_t s = 0; s < count; ++s) {
            const int p = place.empty() ? ends.a[s] : place[ends.a[s]];
            const int q = place.empty() ? ends.b[s] : place[ends.b[s]];
            a[s] = std::min(p, q);
            offset[s] = std::max(p, q) - a[s];
        }
        Buffer<int> order = numbers(count);
        sort_by(a, order);
        sort_by(offset, order);
        springs_.reserve(count);
        for (const int s : order) springs_.push_back({a[s], a[s] + offset[s], s});
        find_runs();
    }

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
    TAUT_COLD void find_runs() {
        const int count = static_cast<int>(springs_.size());
        for (Run run{0, 0}; run.begin < count; run.begin = run.end) {
            run.end = run.begin + 1;
            while (run.end < count && goes_on(springs_[run.end - 1], springs_[run.end])) ++run.end;
            const int length = run.end - run.begin;
            const int places = springs_[run.end - 1].a - springs_[run.begin].a;
            if (length >= shortest_run && 2 * length > places) {
                runs_.push_back(run);
            } else {
                for (int s = run.begin; s < run.end; ++s) scattered_.push_back(s);
            }
        }
    }

    Buffer<PlacedSpring> springs_;
    Buffer<Run> runs_;
    Buffer<int> scattered_;
};

}  // namespace taut::integrator_detail::sweep
