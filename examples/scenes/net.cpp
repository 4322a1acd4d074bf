// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A net catches a ball, a lattice of springs. Writes net00000.obj and so on, 30 a second; z is up.
//
// Method: taut::Guarded, whole frames, and the contact after every step. A string that snaps taut
// may gain energy at a step that is proved at any pose. The guard takes such a frame again.

#include <algorithm>
#include <cstdio>
#include <taut/guard/guard.hpp>
#include <taut/lattice/lattice.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/taut.hpp>
#include <vector>

int main() {
    using taut::Index;
    taut::SpringSystem<double, 3, taut::TensionOnly, taut::Hookean> scene;
    const Index side = 25, knots = side * side;
    taut::MeshEdges strings;
    for (Index i = 0; i < knots; ++i) {
        const Index row = i / side, column = i % side;
        scene.add_particle({0.05 * double(column), 0.05 * double(row), 0}, 2e-3);  // m and kg
        if (row % (side - 1) == 0 || column % (side - 1) == 0) scene.pin(i);
        if (column > 0) strings.push_back({i - 1, i});
        if (row > 0) strings.push_back({i - side, i});
    }
    for (const auto& [a, b] : strings) {  // of 5.2 cm
        scene.add_spring(taut::Spring<double, taut::TensionOnly>{a, b, {1000}, 0.052});
    }
    // The ball: of a block of 9 x 9 x 9 particles those within 0.165 m of the middle one.
    const auto block = taut::lattice<double>({{9, 9, 9}, 0.04, 800, 800, 5e-3});
    const auto placed = block.initial_state();
    std::vector<Index> ball(729, -1);  // index in the scene
    for (Index i = 0; i < 729; ++i) {
        const Eigen::Vector3d out = placed.x.col(i) - placed.x.col(364);
        if (out.norm() > 0.165) continue;
        ball[i] = scene.add_particle(out + Eigen::Vector3d(0.6, 0.6, 0.5), block.mass(i));
    }
    block.visit_springs([&](const auto& s) {
        if (std::min(ball[s.a], ball[s.b]) < 0) return;
        scene.add_spring<taut::Hookean>(ball[s.a], ball[s.b], s.parameters);
    });
    scene.set_gravity({0, 0, -9.81});
    scene.set_rayleigh({1, 1e-3});  // 1/s and s
    // A knot and a particle of the ball stay 0.04 m apart. Momentum is kept, nothing bounces.
    const auto contact = [&](auto& state) {
        for (Index i = 0; i < knots; ++i) {
            if ((state.x.col(i) - state.x.col(ball[364])).norm() > 0.3) continue;
            for (Index j = knots; j < scene.size(); ++j) {
                const Eigen::Vector3d way = state.x.col(j) - state.x.col(i), n = way.normalized();
                if (way.norm() >= 0.04) continue;
                const double into = std::min(n.dot(state.v.col(j) - state.v.col(i)), 0.0);
                state.v.col(i) += 5.0 / 7 * into * n;  // of 2 g, and 5 g
                state.v.col(j) -= 2.0 / 7 * into * n;
                state.x.col(i) -= 5.0 / 7 * (0.04 - way.norm()) * n;
                state.x.col(j) += 2.0 / 7 * (0.04 - way.norm()) * n;
            }
        }
    };
    auto state = scene.initial_state();
    taut::Guarded guard(scene);
    taut::GuardedReport<double> report;
    taut::ObjSequence files("net", {}, strings);
    taut::Points<double, 3> force;
    const Eigen::RowVectorXd pinned = (scene.inverse_mass().array() == 0).cast<double>();
    double pins = 0;  // N, what they carry, the mean of the last four seconds
    for (int frame = 0; frame < 480; ++frame) {
        if (frame < 120 && frame % 2 == 0 && !files.write(state.x)) return 1;
        if (report = guard.advance(state, 1.0 / 60, contact); !report) return 1;
        scene.force(state, force);
        if (frame >= 240) pins -= force.row(2).dot(pinned) / 240;
    }
    std::printf("velocity Verlet, guarded: %d steps of %.3f ms a frame\n", int(report.substeps),
                1e3 * report.h);
    std::printf("the pins carry %.3f N of %.3f kg, the ball is %.3f m down\n", pins,
                2e-3 * double(knots) + 5e-3 * double(scene.size() - knots), -state.x(2, ball[364]));
}
