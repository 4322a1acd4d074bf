// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <taut/taut.hpp>

#include "cloth.hpp"

namespace drape {

/// How a frame is cut: `steps` of h each, contacts resolved after each.
struct Plan {
    int frames = 0;
    double frame = 0;        // s
    taut::Index steps = 1;   // at least, with a guard
    bool shortened = false;  // the guard takes no step as long as that of --step
    double h = 0;            // s, at most
};

/// A particle that falls at 3 m/s enters an obstacle by 12 mm within this time, s.
constexpr double between_contacts = 1.0 / 240;

/// The step that --step leaves open, s. Throws when there is none.
inline double default_step(const Options& options, const Cloth& cloth, double frame) {
    // One linearised solve is wrong about springs that turn taut in a long step.
    const bool linearised = options.integrator == "implicit" || options.integrator == "bdf2";
    const double usual = linearised ? 1.0 / 60 : frame;
    const double contact = options.collide.empty() ? frame : between_contacts;
    const double longest = std::min({frame, usual, contact});
    if (options.implicit()) return longest;
    const bool stable = options.integrator == "energy_stable";
    const auto limit = stable ? taut::energy_limit(cloth) : taut::any_pose_limit(cloth);
    if (limit.unbounded()) return longest;
    if (!(limit.certified > 0)) {
        throw std::runtime_error("no step is certified: " + std::string(describe(limit.cause)));
    }
    return std::min(longest, (stable ? 1 : 0.95) * limit.certified);
}

/// Throws naming the options that ask for too much.
inline Plan make_plan(const Options& options, const Cloth& cloth) {
    Plan plan;
    const double frames = std::round(options.duration * options.frame_rate);
    if (frames > 99999) {
        throw std::runtime_error("--duration, --frame-rate: more than 99999 frames");
    }
    plan.frames = std::max(1, static_cast<int>(frames));
    plan.frame = options.duration / plan.frames;
    double wanted = options.step > 0 ? options.step : default_step(options, cloth, plan.frame);
    if (options.guard && !options.implicit()) {  // it takes no longer ones
        wanted = std::min(wanted, default_step(options, cloth, plan.frame));
        plan.shortened = wanted < options.step;
    }
    if (!(plan.frame / wanted <= 1e9)) {
        throw std::runtime_error("--step: more than 1e9 steps for each frame");
    }
    const auto steps = std::max<taut::Index>(
        1, static_cast<taut::Index>(std::ceil(plan.frame / wanted * (1 - 1e-12))));
    plan.steps = steps;
    plan.h = plan.frame / static_cast<double>(steps);
    return plan;
}

}  // namespace drape
