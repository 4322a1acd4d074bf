// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A curtain, 2 m x 1.4 m, from a mesh is drawn along its rod. Writes curtain00000.obj,
// curtain00001.obj and so on, 10 a second; y is up.
//
// Method: taut::ImplicitEuler, one step a frame. The curtain shall come to rest in its folds, so it
// does not matter that implicit steps damp the swing; they are stable at any length.

#include <cmath>
#include <cstdio>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/scene/mesh.hpp>
#include <taut/taut.hpp>
#include <vector>

int main() {
    // The mesh: vertices and faces, as your reader of files or your engine has them.
    using taut::Index;
    const Index columns = 61, rows = 41;
    taut::Points<double, 3> vertices(3, columns * rows);
    taut::MeshFaces faces;
    for (Index i = 0; i < columns * rows; ++i) {
        const double x = 2.0 * double(i % columns) / double(columns - 1);
        const double y = -1.4 * double(i / columns) / double(rows - 1);
        vertices.col(i) << x, y, 0.01 * std::sin(12 * std::acos(-1.0) * x);  // m
        if (i % columns == 0 || i < columns) continue;
        faces.push_back({i - columns - 1, i - 1, i, i - columns});
    }

    taut::MeshOptions options;
    options.mass = 0.8;      // kg
    options.stretch = 1000;  // N/m
    options.bend = 10;       // N/m
    options.mass_by_area = true;
    auto mesh = taut::springs_from_mesh(vertices, faces, options);
    auto& curtain = mesh.system;  // every vertex is in a face, so particle i is vertex i
    curtain.set_gravity({0, -9.81, 0});
    std::vector<Index> rings;  // every fifth vertex of the upper edge
    for (Index i = 0; i < columns; i += 5) rings.push_back(i);
    for (const Index ring : rings) curtain.pin(ring);

    auto state = curtain.initial_state();
    taut::ImplicitEuler stepper(curtain);
    taut::ObjSequence files("curtain", faces);
    for (int frame = 0; frame < 420; ++frame) {
        if (frame % 6 == 0 && !files.write(state.x)) return 1;
        // A pinned particle moves with the velocity that it is given: for two seconds.
        for (const Index ring : rings) {
            state.v(0, ring) = frame >= 60 && frame < 180 ? -0.3 * vertices(0, ring) : 0;
        }
        if (auto report = stepper.step(state, 1.0 / 60); !report) {
            return std::puts(describe(report.status)), 1;
        }
    }
    taut::Points<double, 3> force;  // N; of a pinned particle: what its pin has to bear
    curtain.force(state, force);
    double carried = 0;
    for (const Index ring : rings) carried -= force(1, ring);
    std::printf("implicit Euler: 1 step of %.3f ms a frame\n", 1e3 / 60);
    std::printf("the rings carry %.4f N of %.3f kg\n", carried, options.mass);
}
