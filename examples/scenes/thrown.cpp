// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The same cloth thrown hard, twice. Writes thrown_others.obj and thrown_taut.obj, both of the
// first frame in which the first has a hundred times its energy; z is up.
//
// Method: once taut::SymplecticEuler, which is position Verlet in other letters, by a number of
// steps a frame that was picked by hand. At rest this step is proved, but a cloth in flight comes
// to poses in which it is too long. Once taut::Guarded, which asks for a step that is proved at any
// pose, takes 0.95 of it, and counts the energy of every frame.

#include <cstdio>
#include <taut/guard/guard.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/taut.hpp>

int main() {
    using taut::Index;
    taut::ClothOptions options;  // 64 x 64 particles, 1 m x 1 m, 0.3 kg, held at two corners
    options.stretch = 100;       // N/m
    options.bend = 10;           // N/m
    const auto cloth = taut::hanging_cloth<double>(options);
    const double frame = 1.0 / 60;     // s
    const Index by_hand = 32;          // steps a frame
    const double h = frame / by_hand;  // s

    auto others = cloth.initial_state();
    const taut::Stability<double> stability(cloth, others);
    const auto at_rest = stability.max_step(taut::Method::symplectic_euler);
    std::printf("proved: about %.4f ms at rest, about %.4f ms at any pose\n",
                1e3 * at_rest.certified, 1e3 * taut::sharp_any_pose_limit(cloth).certified);

    others.v.row(2).setConstant(20);  // m/s, upwards, all but the pins
    others.v.col(0).setZero();
    others.v.col(options.columns - 1).setZero();
    auto guarded = others;
    const double thrown = cloth.energy(others);

    taut::MeshFaces squares;
    for (Index i = 0; i + options.columns < cloth.size(); ++i) {
        if (i % options.columns + 1 == options.columns) continue;
        squares.push_back({i, i + 1, i + 1 + options.columns, i + options.columns});
    }
    taut::SymplecticEuler stepper(cloth);
    taut::Guarded guard(cloth);
    taut::GuardedReport<double> report;
    int torn = 0, overflow = 0;  // frames
    double others_then = 0, guarded_then = 0;
    for (int i = 1; i <= 60; ++i) {
        if (overflow == 0 && !stepper.step(others, h, by_hand)) overflow = i;
        report = guard.advance(guarded, frame);
        if (!report) return std::puts(describe(report.status)), 1;
        if (torn > 0 || cloth.energy(others) < 100 * thrown) continue;
        torn = i;
        others_then = cloth.energy(others);
        guarded_then = cloth.energy(guarded);
        if (!taut::write_obj("thrown_others.obj", others.x, squares)) return 1;
        if (!taut::write_obj("thrown_taut.obj", guarded.x, squares)) return 1;
    }
    std::printf("symplectic Euler, %d steps of %.4f ms a frame: ", int(by_hand), 1e3 * h);
    std::printf("%.2f J become %.0f J in frame %d, not finite in frame %d\n", thrown, others_then,
                torn, overflow);
    std::printf("Guarded, %d steps of %.4f ms a frame: ", int(report.substeps), 1e3 * report.h);
    std::printf("%.2f J become %.2f J in frame %d, %.2f J in frame 60\n", thrown, guarded_then,
                torn, cloth.energy(guarded));
}
