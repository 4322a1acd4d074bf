// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/core/types.hpp>
#include <vector>

#include "../support/random.hpp"

namespace taut_test {

struct ClosedMesh {
    taut::Points<double, 3> points;
    std::vector<taut::Triangle> triangles;
};

/// A ring about the z axis, with bumps.
inline ClosedMesh bumpy_ring(Random& random, taut::Index around, taut::Index across) {
    ClosedMesh mesh;
    mesh.points.resize(3, around * across);
    const double turn = 8 * std::atan(1.0);
    const auto at = [&](taut::Index i, taut::Index j) { return i % around * across + j % across; };
    for (taut::Index i = 0; i < around; ++i) {
        for (taut::Index j = 0; j < across; ++j) {
            const double a = turn * static_cast<double>(i) / static_cast<double>(around);
            const double b = turn * static_cast<double>(j) / static_cast<double>(across);
            const double radius = 0.2 * random.uniform(0.7, 1.3), out = 0.6 + radius * std::cos(b);
            mesh.points.col(at(i, j)) << out * std::cos(a), out * std::sin(a), radius * std::sin(b);
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

/// A ball with spikes and dents: an octahedron of which each face becomes four, and so on.
inline ClosedMesh bumpy_ball(Random& random, int levels) {
    std::vector<Eigen::Vector3d> points = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},
                                           {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    ClosedMesh mesh;
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                      {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
    for (int level = 0; level < levels; ++level) {
        std::vector<taut::Triangle> finer;
        const auto middle = [&](taut::Index a, taut::Index b) {
            const Eigen::Vector3d between =
                (points[std::size_t(a)] + points[std::size_t(b)]).normalized();
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (points[i].isApprox(between)) return taut::Index(i);
            }
            points.push_back(between);
            return taut::Index(points.size()) - 1;
        };
        for (const auto& [a, b, c] : mesh.triangles) {
            const taut::Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        mesh.triangles = finer;
    }
    mesh.points.resize(3, taut::Index(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        mesh.points.col(taut::Index(i)) = random.uniform(0.4, 0.8) * points[i];
    return mesh;
}

}  // namespace taut_test
