// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A flag in a game: the engine's vertices and triangles, a guard, wind, tearing. docs/tutorial.md
// reads along.

#include <cmath>
#include <cstdio>
#include <taut/taut.hpp>
#include <vector>

using Cloth = taut::SpringSystem<float, 3>;
using taut::Index;

struct Vertex {
    float position[3], velocity[3], uv[2];
};

constexpr int rows = 10, columns = 15;

int main() {
    // What your engine has already: vertices and triangles.
    std::vector<Vertex> vertices(rows * columns);
    std::vector<std::vector<Index>> triangles;
    for (int i = 0; i < rows * columns; ++i) {
        vertices[i].position[0] = 0.08f * float(i % columns);
        vertices[i].position[2] = 0.08f * float(i / columns);
        if (i % columns == columns - 1 || i / columns == rows - 1) continue;
        triangles.push_back({i, i + 1, i + columns});
        triangles.push_back({i + 1, i + columns + 1, i + columns});
    }

    taut::StateView<float, 3> view(vertices[0].position, vertices[0].velocity, rows * columns,
                                   sizeof(Vertex) / sizeof(float));
    const taut::MeshOptions options{500, 5, 0.15};  // N/m along edges, N/m across them, kg
    const auto mesh = taut::springs_from_mesh<float>(view.x, triangles, options);
    Cloth flag = mesh.system;
    for (int r = 0; r < rows; ++r) flag.pin(r * columns);  // the mast
    flag.set_gravity({0, 0, -9.81f});
    flag.set_rayleigh({0.1, 2e-4});

    taut::Wind<float> wind;
    wind.triangles = mesh.triangles;
    flag.set_wind(wind);

    taut::Guarded<taut::SymplecticEuler<Cloth>> guard(flag);
    const auto too_long = [&](Index s) {
        const auto& set = flag.springs();
        const float length = (view.x.col(set.b[s]) - view.x.col(set.a[s])).norm();
        return length > 1.25f * set.rest_length[s];
    };

    constexpr Index corner = columns - 1;
    for (int frame = 0; frame < 120; ++frame) {
        const float gust = 8 + 4 * std::sin(0.05f * float(frame));  // m/s
        flag.set_wind_velocity({gust, 2, 0});
        if (frame == 30) flag.pin(corner);  // somebody takes hold of it
        if (frame >= 30) view.v.col(corner) = Eigen::Vector3f(0.5f, 0, 0);  // and pulls, m/s

        const auto report = guard.advance(view, 1.0f / 60);
        if (!report) {
            std::printf("frame %d: %s at particle %d\n", frame, describe(report.status),
                        int(report.where));
            return 1;
        }
        const Index torn = flag.remove_springs(too_long);
        if (frame % 30 == 0 || torn > 0) {
            std::printf("frame %d: %d substeps, %d retries, %d springs torn\n", frame,
                        int(report.substeps), report.retries, int(torn));
        }
    }
}
