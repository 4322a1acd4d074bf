// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A rope bridge of 12 m with a load of 150 kg at a third of its length. Writes bridge.obj; z is up.
//
// Method: taut::Guarded, whole frames. Ropes pull and do not push (taut::TensionOnly). One that
// snaps taut may gain energy at a step that is stable for small vibrations. The guard counts the
// energy of every frame, and takes one that gained again by a step that cannot.

#include <cmath>
#include <cstdio>
#include <taut/guard/guard.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/taut.hpp>

int main() {
    using taut::Index;
    const Index links = 36, third = links / 3;
    const double span = 12, rope = 12.2;  // m, between the posts and along a rope
    const double pull = 50e3;             // N/m of a whole rope
    taut::SpringSystem<double, 3, taut::TensionOnly, taut::Hookean> bridge;
    taut::MeshEdges ropes;
    taut::MeshFaces planks;
    const auto tie = [&](Index a, Index b, double stiffness, double length) {
        bridge.add_spring(taut::Spring<double, taut::TensionOnly>{a, b, {stiffness}, length});
        ropes.push_back({a, b});
    };
    for (Index i = 0; i <= links; ++i) {
        // Of each cross section: deck left and right, handrails left and right.
        const double x = span * double(i) / double(links);
        const Index a = 4 * i;
        bridge.add_particle({x, -0.5, 0}, 3);  // kg, half a plank
        bridge.add_particle({x, 0.5, 0}, 3);
        bridge.add_particle({x, -0.5, 1}, 0.2);
        bridge.add_particle({x, 0.5, 1}, 0.2);
        if (i == 0 || i == links) {
            for (Index j = 0; j < 4; ++j) bridge.pin(a + j);
        } else {
            bridge.add_spring(a, a + 1, 1e5);  // a plank pushes
            tie(a, a + 2, 1e5, 1);
            tie(a + 1, a + 3, 1e5, 1);
        }
        if (i == 0) continue;
        for (Index j = 0; j < 4; ++j) tie(a + j - 4, a + j, pull * links, rope / links);
        planks.push_back({a - 4, a - 3, a + 1, a});
    }
    const Index load = bridge.add_particle({span / 3, 0, -1}, 150);
    tie(load, 4 * third, 1e5, std::hypot(0.5, 1));
    tie(load, 4 * third + 1, 1e5, std::hypot(0.5, 1));
    bridge.set_gravity({0, 0, -9.81});
    bridge.set_rayleigh({1, 0});  // 1/s: air, and ropes that rub

    auto state = bridge.initial_state();
    taut::Guarded guard(bridge);
    taut::GuardedReport<double> report;
    while (state.time < 30) {
        report = guard.advance(state, 1.0 / 60);
        if (!report) return std::puts(describe(report.status)), 1;
    }
    std::printf("velocity Verlet, guarded: %d steps of %.3f ms a frame\n", int(report.substeps),
                1e3 * report.h);
    std::printf("the deck is %.4f m down at the load and %.4f m in the middle\n",
                -state.x(2, 4 * third), -state.x(2, 2 * links));
    return taut::write_obj("bridge.obj", state.x, planks, ropes) ? 0 : 1;
}
