// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <string>

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

inline Advance by_guard(const Scene& scene, const Guard& guard) {
    return [guard, frame = scene.plan.frame, &cloth = scene.cloth,
            &obstacle = scene.obstacle](State& state) {
        std::function<void(State&)> respond;
        if (obstacle) respond = [&](State& s) { obstacle.resolve(cloth, s); };
        Advanced advanced;
        // Steps beyond those that an Index can count shorten a frame.
        for (double left = frame; advanced.trouble.empty() && left > 1e-9 * frame;) {
            const auto report = guard(state, left, respond);
            left -= report.advanced;
            advanced.trouble = name_trouble(report);
            advanced.taken = std::max(advanced.taken, report.taken);
        }
        return advanced;
    };
}

}  // namespace drape
