// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <array>
#include <limits>
#include <optional>
#include <taut/integrator/symplectic_euler.hpp>

#include "lab.hpp"
#include "scene.hpp"

namespace {

struct Run {
    double h = 0;
    lab::Cloth::State state;
    std::optional<taut::SymplecticEuler<lab::Cloth>> stepper;
    bool failed = false;
};

struct Pair {
    lab::Cloth cloth;  // gravity would move it, too, and hide what the kick does
    taut::Points<double, 3> rest;
    taut::Points<double, 3> kick;
    std::array<Run, 2> runs;
    taut::Points<float, 3> drawn;
    Eigen::VectorXf moved;
};

Pair pair;

}  // namespace

double* lab_pair_kick() {
    pair.kick.setZero(3, lab::scene().cloth.size());
    return pair.kick.data();
}

void lab_pair_start(double speed, double below, double above) {
    for (Run& run : pair.runs) run.stepper.reset();
    pair.cloth = lab::scene().cloth;
    pair.cloth.set_gravity({0, 0, 0});
    pair.rest = pair.cloth.initial_state().x;
    for (Run& run : pair.runs) {
        run.h = &run == pair.runs.data() ? below : above;
        run.state = pair.cloth.initial_state();
        run.state.x += pair.kick;
        run.state.v += speed * pair.kick;
        run.failed = false;
        run.stepper.emplace(pair.cloth);
    }
}

double lab_pair_step(int count) {
    for (Run& run : pair.runs)
        run.failed = run.failed || !run.stepper->step(run.state, run.h, count);
    const Run& above = pair.runs[1];
    if (above.failed) return std::numeric_limits<double>::infinity();
    return (above.state.x - pair.rest).colwise().norm().maxCoeff();
}

const float* lab_pair_positions(int which) {
    pair.drawn = pair.runs[std::size_t(which)].state.x.cast<float>();
    return pair.drawn.data();
}

const float* lab_pair_moved(int which) {
    pair.moved = (pair.runs[std::size_t(which)].state.x - pair.rest)
                     .colwise()
                     .norm()
                     .transpose()
                     .cast<float>();
    return pair.moved.data();
}
