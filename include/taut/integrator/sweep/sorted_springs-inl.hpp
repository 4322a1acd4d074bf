// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>

#include "sorted_springs.hpp"

namespace taut::integrator_detail::sweep {

inline Buffer<int> numbers(std::size_t count) {
    Buffer<int> result(count);
    for (std::size_t i = 0; i < count; ++i) result[i] = static_cast<int>(i);
    return result;
}

inline void sort_by(const Buffer<int>& key, Buffer<int>& items) {
    int most = -1;
    for (const int item : items) most = std::max(most, key[item]);
    Buffer<int> next(static_cast<std::size_t>(most) + 2, 0);
    for (const int item : items) ++next[key[item] + 1];
    for (int i = 0; i <= most; ++i) next[i + 1] += next[i];
    Buffer<int> sorted(items.size());
    for (const int item : items) sorted[next[key[item]]++] = item;
    items = std::move(sorted);
}

inline SortedSprings::SortedSprings(const SpringEnds& ends, const Buffer<int>& place) {
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

inline void SortedSprings::find_runs() {
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

}  // namespace taut::integrator_detail::sweep
