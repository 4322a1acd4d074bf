// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A strand of hair or rope, 1 m long, with a bob of 100 g, is let go at 60 degrees and swings.
// Writes rope00000.obj, rope00001.obj and so on, 20 a second, for one swing; y is up.
//
// Method: taut::Guarded, whole frames. A pendulum has to keep its swing. The guard's velocity
// Verlet takes nothing from it, where an implicit step would damp it, and takes 0.95 of the step
// that is proved at any pose.

#include <cmath>
#include <cstdio>
#include <taut/guard/guard.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/taut.hpp>

int main() {
    using taut::Index;
    const Index links = 30;
    const double length = 1, start = std::acos(0.5);  // m, and rad from the vertical
    const double stiffness = 1000;                    // N/m of the whole strand

    taut::SpringSystem<double, 3> strand;
    taut::MeshEdges edges;
    for (Index i = 0; i <= links; ++i) {
        const double s = length * double(i) / double(links);
        strand.add_particle({s * std::sin(start), -s * std::cos(start), 0}, 1e-4);  // kg
        if (i == 0) continue;
        strand.add_spring(i - 1, i, stiffness * double(links));  // each link is so much stiffer
        edges.push_back({i - 1, i});
    }
    strand.set_mass(links, 0.1);  // the bob, kg
    strand.pin(0);
    strand.set_gravity({0, -9.81, 0});

    auto state = strand.initial_state();
    taut::Guarded guard(strand);
    taut::GuardedReport<double> report;
    taut::ObjSequence files("rope", {}, edges);
    double first = 0, last = 0;  // s, when the bob passed below the pin
    int passes = 0;
    for (int frame = 0; frame < 1200; ++frame) {
        const double x = state.x(0, links), time = state.time;
        if (frame < 132 && frame % 6 == 0 && !files.write(state.x)) return 1;
        report = guard.advance(state, 1.0 / 120);
        if (!report) return std::puts(describe(report.status)), 1;
        const double next = state.x(0, links);
        if ((x > 0) == (next > 0)) continue;
        last = time + (state.time - time) * x / (x - next);
        if (passes++ == 0) first = last;
    }
    std::printf("velocity Verlet, guarded: %d steps of %.3f ms a frame\n", int(report.substeps),
                1e3 * report.h);
    std::printf("a strand of %.3f m, let go at %.4f rad, has a period of %.4f s\n", length, start,
                2 * (last - first) / (passes - 1));
}
