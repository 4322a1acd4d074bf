// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/step/planner-inl.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::cache_order_test {

namespace {

taut::Buffer<taut::step_detail::SpringEnds> ends(const std::vector<int>& a,
                                                 const std::vector<int>& b) {
    taut::Buffer<taut::step_detail::SpringEnds> laws;
    laws.push_back({a, b});
    return laws;
}

}  // namespace

TEST_CASE("cache_order: the order of a shuffled grid is a permutation that brings ends together",
          "[integrator]") {
    Random random(51);
    const int side = 40;
    std::vector<int> name(side * side);
    std::iota(name.begin(), name.end(), 0);
    for (std::size_t i = name.size() - 1; i > 0; --i) {
        std::swap(name[i], name[static_cast<std::size_t>(random.below(static_cast<Index>(i) + 1))]);
    }
    std::vector<int> a, b;
    const auto join = [&](int i, int j) {
        a.push_back(name[i]);
        b.push_back(name[j]);
    };
    for (int r = 0; r < side; ++r) {
        for (int c = 0; c < side; ++c) {
            if (c + 1 < side) join(r * side + c, r * side + c + 1);
            if (r + 1 < side) join(r * side + c, (r + 1) * side + c);
        }
    }
    const auto order = taut::step_detail::cache_order(side * side, ends(a, b));
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < side * side; ++i) REQUIRE(sorted[i] == i);
    std::vector<int> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
    int farthest = 0;
    for (std::size_t s = 0; s < a.size(); ++s) {
        farthest = std::max(farthest, std::abs(place[a[s]] - place[b[s]]));
    }
    CHECK(farthest <= 2 * side);
}

TEST_CASE("cache_order: particles without springs keep a place of their own", "[integrator]") {
    const std::vector<int> a{1}, b{3};
    const auto order = taut::step_detail::cache_order(5, ends(a, b));
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < 5; ++i) CHECK(sorted[i] == i);
}

}  // namespace taut_test::cache_order_test
