// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <taut/guard/guard.hpp>
#include <utility>

#include "motion.hpp"

// Steppers and guards behind the one call of a motion.

namespace drape {

inline std::string name_particle(taut::Status status, taut::Index particle) {
    std::string text = describe(status);
    if (particle >= 0) text += ", particle " + std::to_string(particle);
    return text;
}

template <class Report>
std::string name_trouble(const Report& report) {
    if (report) return {};
    std::string text = name_particle(report.status, report.where);
    if (report.spring >= 0) text += ", spring " + std::to_string(report.spring);
    if (report.force) text += ", by " + std::string(report.force);
    return text;
}

inline Advance by_steps(const Scene& scene, const Step& step) {
    const Plan plan = scene.plan;
    const bool contacts = bool(scene.obstacle);
    return [plan, contacts, step, &cloth = scene.cloth,
            &obstacle = scene.obstacle](State& state) -> Advanced {
        const taut::Index at_once = contacts ? 1 : plan.steps;
        for (taut::Index done = 0; done < plan.steps; done += at_once) {
            const taut::Report report = step(state, plan.h, at_once);
            if (!report) return {name_particle(report.status, report.where)};
            obstacle.resolve(cloth, state);
        }
        return {};
    };
}

/// What the guard asks of a stepper: of which steps the method promises what.
template <taut::Method of>
struct StepOf {
    static constexpr taut::Method method = of;
    taut::Report step(State& state, double h, taut::Index count) { return take(state, h, count); }
    Step take;
};

template <taut::Method method>
Advance by_guard(const Scene& scene, const Step& step) {
    using Guarded = taut::Guarded<StepOf<method>, Cloth>;
    typename Guarded::Options options;
    options.max_step = scene.plan.h;
    options.max_substeps = std::numeric_limits<taut::Index>::max();  // a frame is never cut short
    const auto stepper = std::make_shared<StepOf<method>>(StepOf<method>{step});
    const auto guard = std::make_shared<Guarded>(scene.cloth, *stepper, options);
    return [stepper, guard, frame = scene.plan.frame, &cloth = scene.cloth,
            &obstacle = scene.obstacle](State& state) {
        Advanced advanced;
        // Steps beyond those that an Index can count shorten a frame.
        for (double left = frame; advanced.trouble.empty() && left > 1e-9 * frame;) {
            const auto report =
                obstacle
                    ? guard->advance(state, left, [&](State& s) { obstacle.resolve(cloth, s); })
                    : guard->advance(state, left);
            left -= report.advanced;
            advanced.trouble = name_trouble(report);
            advanced.taken = std::max(advanced.taken, report.taken);
        }
        return advanced;
    };
}

}  // namespace drape
