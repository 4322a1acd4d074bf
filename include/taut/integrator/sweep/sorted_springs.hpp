// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "register.hpp"

namespace taut::integrator_detail::sweep {

/// Fewer springs of one offset are not worth a run.
inline constexpr int shortest_run = 16;

/// A spring by the places of its ends, a < b, and its index in the set.
struct PlacedSpring {
    int a;
    int b;
    int index;

    int offset() const { return b - a; }
};

/// Springs by a key in 0 … keys − 1; those of one key stay in their order.
/// @param key_of  key_of(spring)
template <class KeyOf>
std::vector<PlacedSpring> counting_sort(const std::vector<PlacedSpring>& springs, int keys,
                                        const KeyOf& key_of) {
    std::vector<std::size_t> next(static_cast<std::size_t>(keys) + 1, 0);
    for (const auto& spring : springs) ++next[static_cast<std::size_t>(key_of(spring)) + 1];
    for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
    std::vector<PlacedSpring> sorted(springs.size());
    for (const auto& spring : springs) {
        sorted[next[static_cast<std::size_t>(key_of(spring))]++] = spring;
    }
    return sorted;
}

/// The springs of a set sorted into runs, and the scattered ones that fit none.
class SortedSprings {
public:
    /// Springs of one offset and ascending a, among the sorted ones.
    struct Run {
        std::vector<PlacedSpring>::const_iterator begin, end;
        const PlacedSpring& front() const { return *begin; }
        const PlacedSpring& back() const { return *(end - 1); }
    };

    /// @param place_of  place_of(i): the place of particle i
    template <class Set, class PlaceOf>
    SortedSprings(const Set& set, const PlaceOf& place_of) {
        springs_.reserve(set.a.size());
        int places = 0;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const int a = place_of(set.a[s]);
            const int b = place_of(set.b[s]);
            springs_.push_back({std::min(a, b), std::max(a, b), static_cast<int>(s)});
            places = std::max(places, springs_.back().b + 1);
        }
        springs_ = counting_sort(springs_, places, [](const auto& spring) { return spring.a; });
        springs_ = counting_sort(springs_, places, [](const auto& s) { return s.offset(); });
        for (Run run{springs_.cbegin(), {}}; run.begin != springs_.cend(); run.begin = run.end) {
            run.end = run.begin + 1;
            while (run.end != springs_.cend() && goes_on(run.back(), *run.end)) ++run.end;
            const auto count = run.end - run.begin;
            if (count >= shortest_run && 2 * count > run.back().a - run.front().a) {
                runs_.push_back(run);
            } else {
                scattered_.insert(scattered_.end(), run.begin, run.end);
            }
        }
    }
    // A copy's runs would be among the springs of the original.
    SortedSprings(const SortedSprings&) = delete;
    SortedSprings(SortedSprings&&) = default;
    SortedSprings& operator=(SortedSprings&&) = default;

    /// By offset, then by a.
    const std::vector<PlacedSpring>& all() const { return springs_; }
    const std::vector<Run>& runs() const { return runs_; }
    const std::vector<PlacedSpring>& scattered() const { return scattered_; }

private:
    /// A run goes on over a short gap, such as that between the rows of a grid.
    static bool goes_on(const PlacedSpring& last, const PlacedSpring& next) {
        return next.offset() == last.offset() && next.a > last.a && next.a <= last.a + max_width;
    }

    std::vector<PlacedSpring> springs_;
    std::vector<Run> runs_;
    std::vector<PlacedSpring> scattered_;
};

}  // namespace taut::integrator_detail::sweep
