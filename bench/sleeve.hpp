// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "../examples/common/obj_text.hpp"

namespace bench {

/// A small irregular garment: a tube of 500 vertices, each moved at random by up to a fifth of its
/// spacing, with diagonals this way or that and vertices numbered at random, so that a step finds
/// no runs.
inline example::MeshFile sleeve() {
    constexpr taut::Index around = 20, rings = 25;
    std::mt19937 random(1);  // std::uniform_..._distribution differs between libraries
    const auto jitter = [&] { return 0.4 * (double(random()) / 4294967295.0 - 0.5); };
    std::vector<taut::Index> number(around * rings);
    std::iota(number.begin(), number.end(), taut::Index(0));
    for (std::size_t i = number.size() - 1; i > 0; --i) {
        std::swap(number[i], number[random() % (i + 1)]);
    }
    example::MeshFile mesh;
    mesh.vertices.resize(3, around * rings);
    const auto vertex = [&](taut::Index ring, taut::Index place) {
        return number[static_cast<std::size_t>(ring * around + place % around)];
    };
    for (taut::Index ring = 0; ring < rings; ++ring) {
        for (taut::Index place = 0; place < around; ++place) {
            const double angle = 2 * M_PI * (double(place) + jitter()) / around;
            mesh.vertices.col(vertex(ring, place)) << 0.08 * std::cos(angle),
                0.08 * std::sin(angle), -0.6 * (double(ring) + jitter()) / (rings - 1);
        }
    }
    for (taut::Index ring = 0; ring + 1 < rings; ++ring) {
        for (taut::Index place = 0; place < around; ++place) {
            const auto a = vertex(ring, place), b = vertex(ring, place + 1),
                       c = vertex(ring + 1, place + 1), d = vertex(ring + 1, place);
            if (random() % 2 == 0) {
                mesh.faces.push_back({a, b, c});
                mesh.faces.push_back({a, c, d});
            } else {
                mesh.faces.push_back({a, b, d});
                mesh.faces.push_back({b, c, d});
            }
        }
    }
    for (std::size_t i = mesh.faces.size() - 1; i > 0; --i) {
        std::swap(mesh.faces[i], mesh.faces[random() % (i + 1)]);
    }
    return mesh;
}

}  // namespace bench
