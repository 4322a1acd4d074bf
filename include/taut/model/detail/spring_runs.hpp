// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "lanes.hpp"

namespace taut::detail {

/// Fewer springs of one offset are not worth a run.
inline constexpr int shortest_run = 16;

/// A spring of a set with its ends in the plan's numbering, a < b.
struct NumberedSpring {
    int a;
    int b;
    int index;

    friend bool operator<(const NumberedSpring& s, const NumberedSpring& t) {
        return std::tuple(s.b - s.a, s.a, s.index) < std::tuple(t.b - t.a, t.a, t.index);
    }
};

/// The springs of a set under a numbering: runs, and the rest.
class SpringRuns {
public:
    /// Springs [first, last) of one offset b − a and ascending a, some a left out.
    struct Run {
        std::size_t first;
        std::size_t last;
    };

    template <class Set, class Number>
    SpringRuns(const Set& set, const Number& number) {
        springs_.reserve(set.a.size());
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const int a = number(set.a[s]);
            const int b = number(set.b[s]);
            springs_.push_back({std::min(a, b), std::max(a, b), static_cast<int>(s)});
        }
        std::sort(springs_.begin(), springs_.end());
        for (std::size_t first = 0, last = 0; first < springs_.size(); first = last) {
            for (last = first + 1; last < springs_.size() && go_on(last);) ++last;
            const auto begin = springs_.begin() + static_cast<std::ptrdiff_t>(first);
            const auto end = springs_.begin() + static_cast<std::ptrdiff_t>(last);
            const auto count = static_cast<int>(last - first);
            if (count >= shortest_run && 2 * count > (end - 1)->a - begin->a) {
                runs_.push_back({first, last});
            } else {
                rest_.insert(rest_.end(), begin, end);
            }
        }
    }
    const NumberedSpring& spring(std::size_t i) const { return springs_[i]; }
    const std::vector<Run>& runs() const { return runs_; }
    const std::vector<NumberedSpring>& rest() const { return rest_; }

private:
    /// A run goes on over a short gap, such as that between the rows of a grid.
    bool go_on(std::size_t i) const {
        const auto& last = springs_[i - 1];
        const auto& next = springs_[i];
        return next.b - next.a == last.b - last.a && next.a > last.a &&
               next.a <= last.a + most_lanes;
    }

    std::vector<NumberedSpring> springs_;  // by offset, then by a
    std::vector<Run> runs_;
    std::vector<NumberedSpring> rest_;
};

/// Orders springs so that neighbours in the list have different ends: first one of each a, then
/// another of each. To add to the force just stored would be to wait for the store.
inline void spread(std::vector<NumberedSpring>& springs) {
    std::sort(springs.begin(), springs.end(), [](const auto& s, const auto& t) {
        return std::tuple(s.a, s.b, s.index) < std::tuple(t.a, t.b, t.index);
    });
    std::vector<std::pair<int, NumberedSpring>> ranked;
    for (const auto& spring : springs) {
        const bool another = !ranked.empty() && ranked.back().second.a == spring.a;
        ranked.emplace_back(another ? ranked.back().first + 1 : 0, spring);
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& s, const auto& t) { return s.first < t.first; });
    for (std::size_t i = 0; i < springs.size(); ++i) springs[i] = ranked[i].second;
}

}  // namespace taut::detail
