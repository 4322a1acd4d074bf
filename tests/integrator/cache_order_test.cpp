// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/sweep/cache_order.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::cache_order_test {

TEST_CASE("cache_order: the order of a shuffled grid is a permutation that brings ends together",
          "[integrator]") {
    Random random(51);
    const int side = 40;
    std::vector<int> name(side * side);
    std::iota(name.begin(), name.end(), 0);
    for (std::size_t i = name.size() - 1; i > 0; --i) {
        std::swap(name[i], name[static_cast<std::size_t>(random.below(static_cast<Index>(i) + 1))]);
    }
    std::vector<taut::integrator_detail::sweep::Edge> edges;
    for (int r = 0; r < side; ++r) {
        for (int c = 0; c < side; ++c) {
            if (c + 1 < side) edges.emplace_back(name[r * side + c], name[r * side + c + 1]);
            if (r + 1 < side) edges.emplace_back(name[r * side + c], name[(r + 1) * side + c]);
        }
    }
    const auto order = taut::integrator_detail::sweep::cache_order(side * side, edges);
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < side * side; ++i) REQUIRE(sorted[i] == i);
    std::vector<int> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
    int farthest = 0;
    for (const auto& [a, b] : edges) farthest = std::max(farthest, std::abs(place[a] - place[b]));
    CHECK(farthest <= 2 * side);
}

TEST_CASE("cache_order: particles without springs keep a place of their own", "[integrator]") {
    const auto order = taut::integrator_detail::sweep::cache_order(5, {{1, 3}});
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    CHECK(sorted == std::vector<int>{0, 1, 2, 3, 4});
}

}  // namespace taut_test::cache_order_test
