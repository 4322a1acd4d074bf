// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace taut::integrator_detail::sweep {

/// Two particles that a spring joins, by their indices in the system.
using Edge = std::pair<int, int>;

/// An order of n particles that brings the ends of springs close together (Cuthill and McKee, 1969,
/// reversed): particle order[p] of the system goes to place p.
inline std::vector<int> cache_order(int n, const std::vector<Edge>& edges) {
    std::vector<int> first(static_cast<std::size_t>(n) + 1, 0);
    for (const auto& [a, b] : edges) {
        ++first[static_cast<std::size_t>(a) + 1];
        ++first[static_cast<std::size_t>(b) + 1];
    }
    for (std::size_t i = 0; i + 1 < first.size(); ++i) first[i + 1] += first[i];
    std::vector<int> neighbour(2 * edges.size());
    auto next = first;
    for (const auto& [a, b] : edges) {
        neighbour[next[a]++] = b;
        neighbour[next[b]++] = a;
    }
    const auto degree = [&](int i) { return first[i + 1] - first[i]; };
    const auto by_degree = [&](int i, int j) {
        return std::pair(degree(i), i) < std::pair(degree(j), j);
    };

    std::vector<int> start(n);
    for (int i = 0; i < n; ++i) start[i] = i;
    std::sort(start.begin(), start.end(), by_degree);
    std::vector<char> known(n, 0);
    std::vector<int> order;
    order.reserve(n);
    for (const int root : start) {
        if (known[root]) continue;
        known[root] = 1;
        order.push_back(root);
        for (std::size_t head = order.size() - 1; head < order.size(); ++head) {
            const int i = order[head];
            const std::size_t level = order.size();
            for (int k = first[i]; k < first[i + 1]; ++k) {
                if (std::exchange(known[neighbour[k]], 1) == 0) order.push_back(neighbour[k]);
            }
            std::sort(order.begin() + static_cast<std::ptrdiff_t>(level), order.end(), by_degree);
        }
    }
    std::reverse(order.begin(), order.end());
    return order;
}

}  // namespace taut::integrator_detail::sweep
