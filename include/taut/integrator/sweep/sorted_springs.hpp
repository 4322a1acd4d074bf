// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

#include "register.hpp"

namespace taut::detail::sweep {

/// Fewer springs of one offset are not worth a run.
inline constexpr int shortest_run = 16;

/// A spring by the places of its ends, a < b, and its index in the set.
struct PlacedSpring {
    int a;
    int b;
    int index;

    int offset() const { return b - a; }
    friend bool operator<(const PlacedSpring& s, const PlacedSpring& t) {
        return std::tuple(s.offset(), s.a, s.index) < std::tuple(t.offset(), t.a, t.index);
    }
};

/// The springs of a set sorted into runs, and the scattered ones that fit none.
class SortedSprings {
public:
    /// Springs of one offset and ascending a.
    using Run = std::vector<PlacedSpring>;

    /// @param place_of  place_of(i): the place of particle i
    template <class Set, class PlaceOf>
    SortedSprings(const Set& set, const PlaceOf& place_of) {
        std::vector<PlacedSpring> springs;
        springs.reserve(set.a.size());
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const int a = place_of(set.a[s]);
            const int b = place_of(set.b[s]);
            springs.push_back({std::min(a, b), std::max(a, b), static_cast<int>(s)});
        }
        std::sort(springs.begin(), springs.end());
        for (auto first = springs.cbegin(); first != springs.cend();) {
            auto last = first + 1;
            while (last != springs.cend() && goes_on(*(last - 1), *last)) ++last;
            if (last - first >= shortest_run && 2 * (last - first) > (last - 1)->a - first->a) {
                runs_.emplace_back(first, last);
            } else {
                scattered_.insert(scattered_.end(), first, last);
            }
            first = last;
        }
    }
    const std::vector<Run>& runs() const { return runs_; }
    const std::vector<PlacedSpring>& scattered() const { return scattered_; }

private:
    /// A run goes on over a short gap, such as that between the rows of a grid.
    static bool goes_on(const PlacedSpring& last, const PlacedSpring& next) {
        return next.offset() == last.offset() && next.a > last.a && next.a <= last.a + most_lanes;
    }

    std::vector<Run> runs_;
    std::vector<PlacedSpring> scattered_;
};

}  // namespace taut::detail::sweep
