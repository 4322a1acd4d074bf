// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "triangles.hpp"

namespace taut::step_detail {

/// Pairs the triangles of an irregular mesh, so that few are left alone: next comes always one with
/// the fewest neighbours that are left, and it takes that with the fewest.
class TrianglePairing {
public:
    explicit TrianglePairing(const std::vector<PlacedTriangle>& triangles);

    const std::vector<TrianglePair>& pairs() const { return pairs_; }

private:
    void find_neighbours();
    /// Neighbours of t that are left.
    std::size_t left_of(int t) const {
        std::size_t count = 0;
        for (const int n : neighbours_[t]) {
            if (n >= 0 && !taken_[n]) ++count;
        }
        return count;
    }
    void take(int t) {
        taken_[t] = true;
        for (const int n : neighbours_[t]) {
            if (n >= 0 && !taken_[n]) queue_[left_of(n)].push_back(n);
        }
    }
    void pair(int t);

    const PlacedTriangle* triangles_;
    Buffer<std::array<int, 3>> neighbours_;  // of each triangle, −1 for none
    Buffer<bool> taken_;
    std::array<std::vector<int>, 4> queue_;  // by the number of neighbours left; may be out of date
    std::vector<TrianglePair> pairs_;
};

inline TrianglePairing::TrianglePairing(const std::vector<PlacedTriangle>& triangles)
    : triangles_(triangles.data()),
      neighbours_(triangles.size(), {-1, -1, -1}),
      taken_(triangles.size(), false) {
    find_neighbours();
    const int count = static_cast<int>(triangles.size());
    for (int t = count - 1; t >= 0; --t) queue_[left_of(t)].push_back(t);
    for (std::size_t left = 0; left < queue_.size();) {
        if (queue_[left].empty()) {
            ++left;
            continue;
        }
        const int t = queue_[left].back();
        queue_[left].pop_back();
        if (taken_[t] || left_of(t) != left) continue;
        pair(t);
        left = 0;
    }
}

inline void TrianglePairing::find_neighbours() {
    struct Side {
        std::pair<int, int> edge;
        int triangle;
        std::size_t number;
    };
    std::vector<Side> sides;
    for (int t = 0; t < static_cast<int>(neighbours_.size()); ++t) {
        for (std::size_t k = 0; k < 3; ++k)
            sides.push_back({edge_opposite(triangles_[t], k), t, k});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
        return std::tie(s.edge, s.triangle) < std::tie(t.edge, t.triangle);
    });
    TrianglePair unused;
    for (std::size_t i = 1; i < sides.size(); ++i) {
        const Side& s = sides[i - 1];
        const Side& t = sides[i];
        // Of more than two at one edge, the first two.
        if (s.edge != t.edge || neighbours_[s.triangle][s.number] >= 0 ||
            !join(triangles_[s.triangle], triangles_[t.triangle], unused)) {
            continue;
        }
        neighbours_[s.triangle][s.number] = t.triangle;
        neighbours_[t.triangle][t.number] = s.triangle;
    }
}

inline void TrianglePairing::pair(int t) {
    int best = -1;
    for (const int n : neighbours_[t]) {
        if (n >= 0 && !taken_[n] && (best < 0 || left_of(n) < left_of(best))) best = n;
    }
    TrianglePair pair = pair_of(triangles_[t]);
    taken_[t] = true;
    if (best >= 0) {
        join(triangles_[t], triangles_[best], pair);
        take(best);
    }
    take(t);
    pairs_.push_back(pair);
}

/// Pairs triangles: in the order of the list where nearly all neighbours there have an edge in
/// common, as the triangles of squares have; else by TrianglePairing.
inline std::vector<TrianglePair> pair_triangles(const std::vector<PlacedTriangle>& triangles) {
    std::vector<TrianglePair> pairs;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        pairs.push_back(pair_of(triangles[t]));
        if (t + 1 < triangles.size() && join(triangles[t], triangles[t + 1], pairs.back())) ++t;
    }
    if (20 * pairs.size() > 11 * triangles.size()) return TrianglePairing(triangles).pairs();
    return pairs;
}

}  // namespace taut::step_detail
