// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/wind/triangle_pairing.hpp>
#include <taut/scene/cloth.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"

namespace taut_test::triangle_pairing_test {

namespace {

namespace step_detail = taut::step_detail;
using Triangles = std::vector<step_detail::PlacedTriangle>;

Triangles grid(int rows, int columns) {
    taut::ClothOptions options;
    options.rows = rows;
    options.columns = columns;
    Triangles result;
    for (const auto& [a, b, c] : taut::cloth_triangles(options)) {
        result.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
    }
    return result;
}

void shuffle(Random& random, Triangles& triangles) {
    for (std::size_t i = triangles.size(); i > 1; --i) {
        std::swap(triangles[i - 1],
                  triangles[static_cast<std::size_t>(random.below(static_cast<Index>(i)))]);
    }
    for (auto& triangle : triangles) {
        std::rotate(triangle.begin(), triangle.begin() + random.below(3), triangle.end());
    }
}

Triangles sorted(Triangles triangles) {
    for (auto& triangle : triangles) std::sort(triangle.begin(), triangle.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// The triangles of pairs that have an area, and how many are alone.
std::pair<Triangles, int> opened(const std::vector<step_detail::TrianglePair>& pairs) {
    Triangles triangles;
    int alone = 0;
    for (const auto& [corner] : pairs) {
        const auto& [a, b, c, d] = corner;
        CHECK(b <= c);
        CHECK(a != d);  // a triangle twice is no pair
        triangles.push_back({a, b, c});
        if (d == b) {
            ++alone;
        } else {
            triangles.push_back({b, c, d});
        }
    }
    return {triangles, alone};
}

}  // namespace

TEST_CASE("pairs of triangles hold each triangle once, whatever the mesh", "[integrator]") {
    Random random(81);
    for (int scene = 0; scene < 200; ++scene) {
        Triangles triangles;
        const Index particles = 3 + random.below(40);
        for (Index t = random.below(120); t > 0; --t) {  // edges of many triangles, copies too
            step_detail::PlacedTriangle triangle;
            for (int& corner : triangle) corner = static_cast<int>(random.below(particles));
            if (triangle[0] == triangle[1] || triangle[1] == triangle[2] ||
                triangle[2] == triangle[0]) {
                continue;  // without area: alone or not is all the same
            }
            triangles.push_back(triangle);
            if (random.below(5) == 0) triangles.push_back(triangle);
        }
        CHECK(sorted(opened(step_detail::pair_triangles(triangles)).first) == sorted(triangles));
        CHECK(sorted(opened(step_detail::TrianglePairing(triangles).pairs()).first) ==
              sorted(triangles));
    }
}

TEST_CASE("few triangles of a mesh stay alone, in order or not", "[integrator]") {
    Random random(82);
    for (const int rows : {2, 9, 60}) {
        auto triangles = grid(rows, 41);
        CHECK(opened(step_detail::pair_triangles(triangles)).second == 0);
        shuffle(random, triangles);
        const auto [all, alone] = opened(step_detail::pair_triangles(triangles));
        CHECK(sorted(all) == sorted(triangles));
        CHECK(alone <= static_cast<int>(triangles.size()) / 20);
    }
}

}  // namespace taut_test::triangle_pairing_test
