// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A flag of 1.5 m x 1 m in a wind of 8 m/s that turns to and fro. Writes flag.obj; y is up.
//
// Method: taut::Guarded, whole frames. Wind shakes the cloth without end and is in no step limit.
// The guard tries velocity Verlet, which keeps the waves alive, at 0.95 of the step that is proved
// at any pose. It counts the work of the wind, and takes a frame that gained more than that again.

#include <cstdio>
#include <taut/guard/guard.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/taut.hpp>
#include <taut/wind/wind.hpp>

int main() {
    using taut::Index;
    taut::ClothOptions options;
    options.rows = 25;
    options.columns = 37;
    options.width = 1.5;  // m, along x, away from the pole
    options.height = 1;   // m, along y
    options.mass = 0.3;   // kg
    options.bend = 20;    // N/m
    options.pin_corners = false;
    auto flag = taut::hanging_cloth<double>(options);
    flag.set_gravity({0, -9.81, 0});
    flag.set_rayleigh({0, 2e-4});  // s: small ripples die out, for 1.7 times the steps
    for (Index row = 0; row < options.rows; ++row) flag.pin(row * options.columns);

    taut::Wind<double> wind;
    wind.velocity = {8, 0, 1};  // m/s
    wind.triangles = taut::cloth_triangles(options);
    taut::set_wind(flag, wind);

    auto state = flag.initial_state();
    taut::Guarded guard(flag);
    taut::GuardedReport<double> report;
    taut::Points<double, 3> all, air;  // forces, N
    double pole = 0, lift = 0;         // what carries the flag, N, the mean from frame 120 on
    const int frames = 725, first = 120;
    for (int frame = 0; frame < frames; ++frame) {
        if (frame % 90 == 0) taut::set_wind_velocity(flag, {8, 0, frame % 180 == 0 ? 1.5 : -1.5});
        report = guard.advance(state, 1.0 / 60);
        if (!report) return std::puts(describe(report.status)), 1;
        if (frame < first) continue;
        flag.force(state, all);  // of a pinned particle: what its pin has to bear
        flag.external_force(state, air);
        for (Index row = 0; row < options.rows; ++row) {
            pole -= all(1, row * options.columns) / (frames - first);
        }
        lift += air.row(1).sum() / (frames - first);
    }
    std::printf("velocity Verlet, guarded: %d steps of %.3f ms a frame\n", int(report.substeps),
                1e3 * report.h);
    std::printf("the pole carries %.3f N and the air %.3f N of %.3f kg\n", pole, lift,
                options.mass);

    taut::MeshFaces squares;
    for (Index i = 0; i + options.columns < flag.size(); ++i) {
        if (i % options.columns + 1 == options.columns) continue;
        squares.push_back({i, i + 1, i + 1 + options.columns, i + options.columns});
    }
    return taut::write_obj("flag.obj", state.x, squares) ? 0 : 1;
}
