// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/proof/stability.hpp>
#include <utility>
#include <vector>

#include "kick.hpp"
#include "scene.hpp"

// A scene kicked along its limiting mode and stepped just below and just above the limit.

namespace example {

struct KickedRun {
    /// The limiting mode turns over at every step: shown at each, it would flicker.
    static constexpr int steps_a_frame = 2;

    double h = 0;                                 // s
    std::vector<double> reach;                    // m, the largest displacement; [0]: the kick
    std::vector<taut::Points<double, 3>> frames;  // displacements, m
};

inline double diagonal(const Scene& scene) {
    const auto x = scene.system.initial_state().x;
    return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
}

inline double mean_edge(const Scene& scene) {
    const auto x = scene.system.initial_state().x;
    double sum = 0;
    std::size_t edges = 0;
    for (const auto& face : scene.faces) {
        for (std::size_t i = 0; i < face.size(); ++i)
            sum += (x.col(face[i]) - x.col(face[(i + 1) % face.size()])).norm();
        edges += face.size();
    }
    return sum / static_cast<double>(edges);
}

/// Symplectic Euler from the initial pose displaced by `kick` and moving at `speed`·kick, until a
/// particle has gone farther than `far` or for `steps` steps.
inline KickedRun kicked_run(const System& system, const taut::Points<double, 3>& kick, double speed,
                            double h, taut::Index steps, double far) {
    const auto rest = system.initial_state().x;
    auto state = system.initial_state();
    state.x += kick;
    state.v += speed * kick;
    taut::SymplecticEuler stepper(system);
    KickedRun run;
    run.h = h;
    for (taut::Index i = 0; i <= steps; ++i) {
        if (i > 0 && !stepper.step(state, h)) break;
        const taut::Points<double, 3> displacement = state.x - rest;
        run.reach.push_back(displacement.colwise().norm().maxCoeff());
        if (i % KickedRun::steps_a_frame == 0) run.frames.push_back(displacement);
        if (!(run.reach.back() <= far)) break;
    }
    return run;
}

struct RunsNearLimit {
    double kick = 0;   // m, of the particle that moves most
    double speed = 0;  // 1/s, the kick's velocity over its displacement
    KickedRun above;
    KickedRun below;
};

inline RunsNearLimit run_near_limit(const System& system, double edge,
                                    const taut::StepLimit<double>& limit, const taut::Mode& mode) {
    const Kick kick = kick_along(system, edge, limit, mode);
    const auto rest = system.initial_state().x;
    const double far = 0.25 * (rest.rowwise().maxCoeff() - rest.rowwise().minCoeff()).norm();
    RunsNearLimit runs;
    runs.kick = kick.size;
    runs.speed = kick.speed;
    runs.above =
        kicked_run(system, kick.shape, kick.speed, above_limit * limit.refuted, kick.steps, far);
    const auto steps = static_cast<taut::Index>(runs.above.reach.size()) - 1;
    runs.below =
        kicked_run(system, kick.shape, kick.speed, below_limit * limit.certified, steps, far);
    return runs;
}

/// Of how many frames one is kept, so that both runs stay near 1.5 MB as text.
inline std::size_t frame_stride(std::size_t frames, std::size_t particles) {
    constexpr std::size_t bytes = 1'100'000;
    constexpr std::size_t fewest = 8;
    const std::size_t kept = std::max(fewest, bytes / (8 * std::max<std::size_t>(particles, 1)));
    return (frames + kept - 1) / kept;
}

inline KickedRun every(KickedRun run, std::size_t stride) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < run.frames.size(); i += stride) run.frames[kept++] = run.frames[i];
    run.frames.resize(kept);
    return run;
}

}  // namespace example
