// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <vector>

#include "../../examples/common/pins.hpp"
#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::pins_test {

namespace {

using Set = std::set<Index>;

Set as_set(const std::vector<Index>& list) { return {list.begin(), list.end()}; }

}  // namespace

TEST_CASE("pins: a box holds the vertices between its corners, however these are named",
          "[programs]") {
    Random random(8);
    for (int trial = 0; trial < 50; ++trial) {
        const Index n = 20 + random.below(50);
        const auto x = random.points<double, 3>(n, -1, 1);
        std::vector<double> corners;
        for (int c = 0; c < 6; ++c) corners.push_back(random.uniform(-1.5, 1.5));
        // A face of the box goes through a vertex.
        corners[0] = x(0, 0);
        corners[3] = 1;
        const auto is_used = [](Index v) { return v % 5 != 3; };
        Set inside;
        for (Index v = 0; v < n; ++v) {
            bool in = is_used(v);
            for (int c = 0; c < 3; ++c)
                in = in && std::min(corners[c], corners[c + 3]) <= x(c, v) &&
                     x(c, v) <= std::max(corners[c], corners[c + 3]);
            if (in) inside.insert(v);
        }
        if (inside.empty()) {
            CHECK_THROWS_WITH(
                example::vertices_in_box(x, corners, is_used),
                Catch::Contains("--pin-box: no vertex") && Catch::Contains("reaches from ("));
            continue;
        }
        CHECK(as_set(example::vertices_in_box(x, corners, is_used)) == inside);
        std::swap(corners[1], corners[4]);
        CHECK(as_set(example::vertices_in_box(x, corners, is_used)) == inside);
    }
}

TEST_CASE("pins: the highest share: none that stays is higher, and ties go together",
          "[programs]") {
    Random random(9);
    for (int trial = 0; trial < 50; ++trial) {
        const Index n = 1 + random.below(60);
        auto x = random.points<double, 3>(n, -1, 1);
        if (trial % 2 == 0) x = (4 * x.array()).round().matrix() / 4;  // many at one height
        const Eigen::Vector3d up = random.vector<double, 3>(-1, 1).normalized();
        const double share = random.uniform(0.001, 1);
        const auto is_used = [](Index v) { return v % 7 != 6; };
        const Set top = as_set(example::highest_vertices(x, up, share, is_used));
        Index used = 0;
        double lowest = 2, highest_left = -2;
        for (Index v = 0; v < n; ++v) {
            if (!is_used(v)) {
                CHECK(top.count(v) == 0);
                continue;
            }
            ++used;
            const double height = up.dot(x.col(v));
            if (top.count(v) > 0) {
                lowest = std::min(lowest, height);
            } else {
                highest_left = std::max(highest_left, height);
            }
        }
        CHECK(lowest > highest_left);
        CHECK(static_cast<double>(top.size()) >= std::max(1.0, std::floor(share * double(used))));
        CHECK(example::highest_vertices(x, up, 0, is_used).empty());
    }
    // A flat cloth that lies is all of one height.
    CHECK_THROWS_WITH(
        example::highest_vertices(taut::Points<double, 3>::Zero(3, 9), Eigen::Vector3d::UnitY(),
                                  0.1, [](Index) { return true; }),
        Catch::Contains("--pin-top: all vertices are as high"));
}

}  // namespace taut_test::pins_test
