// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "../../core/buffer.hpp"
#include "coarse_springs.hpp"

namespace taut::scene_detail {

/// For each particle of a fine network the weights of up to four of a coarse one, which sum to 1.
struct Lift {
    struct Row {
        std::array<int, 4> coarse{};  // the first `count` of them
        std::array<double, 4> weight{};
        std::size_t count = 0;
    };
    std::vector<Row> rows;
};

/// The seeds of the particle's own cluster and of those that springs join to it: the four nearest
/// in the pose, weighted as Franke and Nielson do, "Smooth interpolation of large sets of scattered
/// data" (1980): ((R − d)/(R d))² with the fifth's distance for R, where a weight that comes in
/// begins at 0. A seed has its own displacement.
/// @param x      m, Dim × n, the pose
/// @param pairs  of joined clusters, sorted, each once
template <class Positions>
Lift make_lift(const Positions& x, const Clusters& clusters,
               const std::vector<ClusterPair>& pairs) {
    const std::size_t count = clusters.seeds.size();
    std::vector<std::vector<int>> candidates(count);
    for (std::size_t c = 0; c < count; ++c) candidates[c].push_back(static_cast<int>(c));
    for (const ClusterPair pair : pairs) {
        detail::at(candidates, low_of(pair)).push_back(high_of(pair));
        detail::at(candidates, high_of(pair)).push_back(low_of(pair));
    }
    Lift lift;
    lift.rows.resize(clusters.of.size());
    std::vector<std::pair<double, int>> nearest;
    for (std::size_t i = 0; i < clusters.of.size(); ++i) {
        Lift::Row& row = lift.rows[i];
        const int own = clusters.of[i];
        if (clusters.seeds[own] == static_cast<int>(i)) {
            row.coarse[0] = own;
            row.weight[0] = 1;
            row.count = 1;
            continue;
        }
        nearest.clear();
        for (const int c : detail::at(candidates, own))
            nearest.emplace_back((x.col(clusters.seeds[c]) - x.col(static_cast<Index>(i))).norm(),
                                 c);
        const std::size_t five = std::min<std::size_t>(5, nearest.size());
        std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(five),
                          nearest.end());
        // Without a fifth nothing comes in: any R beyond the last serves.
        const double R = five == 5 ? nearest[4].first : 2 * nearest[five - 1].first;
        double sum = 0;
        for (std::size_t k = 0; k < std::min<std::size_t>(4, five); ++k) {
            const auto [d, c] = nearest[k];
            if (!(d > 0)) {  // it lies on this seed
                row.coarse[0] = c;
                row.weight[0] = sum = 1;
                row.count = 1;
                break;
            }
            if (!(d < R)) break;
            const double root = (R - d) / (R * d);
            row.coarse[row.count] = c;
            row.weight[row.count++] = root * root;
            sum += root * root;
        }
        if (row.count == 0) {  // five at one distance
            row.coarse[row.count++] = own;
            row.weight[0] = sum = 1;
        }
        for (std::size_t k = 0; k < row.count; ++k) row.weight[k] /= sum;
    }
    return lift;
}

}  // namespace taut::scene_detail
