// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>

#include "findings.hpp"
#include "resolution_report.hpp"

// What stability_report found, as JSON.

namespace example {

/// null: none is safe, or none is known to fail. "unbounded": every step is safe.
inline Json certified_json(const taut::StepLimit<double>& limit) {
    if (limit.unbounded()) return "unbounded";
    return limit.certified > 0 ? Json(limit.certified) : Json(nullptr);
}

inline Json limit_json(const taut::StepLimit<double>& limit) {
    return {{"certified", certified_json(limit)},
            {"refuted", std::isfinite(limit.refuted) ? Json(limit.refuted) : Json(nullptr)},
            {"cause", name(limit.cause)},
            {"growth_rate", limit.growth_rate},
            {"certified_up_to",
             limit.certified_up_to > 0 ? Json(limit.certified_up_to) : Json(nullptr)},
            {"admitted_growth", limit.admitted_growth},
            {"estimate", limit.estimate > 0 ? Json(limit.estimate) : Json(nullptr)}};
}

template <class T>
inline Json optional_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// Of a limit that bare matrices do not have.
inline Json limit_json(const std::optional<taut::StepLimit<double>>& limit) {
    return limit ? limit_json(*limit) : Json{{"certified", nullptr}, {"refuted", nullptr}};
}

/// standing and growth are of this pose; any_pose is null for bare matrices.
inline Json verdict_json(const Findings& found, const Verdict& verdict) {
    Json json{{"h", verdict.step},
              {"standing", name(verdict.standing)},
              {"growth", verdict.growth > 1 ? Json(verdict.growth) : Json(nullptr)},
              {"any_pose", nullptr}};
    if (found.any_pose) {
        const auto substeps = found.any_pose->substeps(verdict.step, safe_part);
        json["any_pose"] = {{"proved", found.any_pose->substeps(verdict.step, 1) == 1},
                            {"substeps", optional_json(substeps)}};
    }
    return json;
}

inline Json to_json(const Findings& found, double d0) {
    const auto bracket = [](const taut::EigenvalueBracket& k) {
        return Json{{"lower", k.lower}, {"upper", k.upper}};
    };
    const auto& window = found.window;
    const bool empty = window.empty != taut::EmptyWindow::none;
    Json json;
    json["degrees_of_freedom"] = found.degrees_of_freedom;
    json["particles"] = optional_json(found.particles);
    json["springs"] = optional_json(found.springs);
    json["zero_modes"] = optional_json(found.zero_modes);
    json["k_min"] = bracket(found.spectrum.k_min);
    json["k_max"] = bracket(found.spectrum.k_max);
    json["explicit_euler"] = limit_json(found.explicit_euler);
    json["symplectic_euler"] = limit_json(found.symplectic_euler);
    json["implicit_euler"] = limit_json(found.implicit_euler);
    json["any_pose"] = limit_json(found.any_pose);
    json["energy_stable"] = limit_json(found.energy_stable);
    json["rayleigh_window"] = {{"method", name(Method::explicit_euler)},
                               {"h", found.window_step},
                               {"d0", d0},
                               {"lower", empty ? Json(nullptr) : Json(window.lower)},
                               {"upper", empty                         ? Json(nullptr)
                                         : std::isfinite(window.upper) ? Json(window.upper)
                                                                       : Json("unbounded")},
                               {"empty", empty},
                               {"includes_zero", window.includes_zero}};
    if (found.verdict) json["step"] = verdict_json(found, *found.verdict);
    for (const auto& spring : found.springs_to_blame) {
        json["limiting_springs"].push_back(
            {{"index", spring.index}, {"a", spring.a}, {"b", spring.b}, {"share", spring.share}});
    }
    for (const auto& particle : found.particles_to_blame) {
        json["limiting_particles"].push_back(
            {{"index", particle.index}, {"share", particle.share}});
    }
    if (found.proof) {
        json["proof"] = {{"method", name(found.proof->method)},
                         {"h", found.proof->step},
                         {"proved", found.proof->proved}};
    }
    if (found.remedies) {
        const auto& [verdict, cures] = *found.remedies;
        json["want_step"] = verdict_json(found, verdict);
        auto& want = json["want_step"];
        want["safe"] = found.is_safe(verdict);
        want["cures_hold"] = found.any_pose ? "any_pose" : "this_pose";
        want["cures_are_near"] = cures.are_near();
        want["stiffness_scale"] = cures.stiffness_scale;
        want["mass_scale"] = cures.mass_scale;
        want["added_mass"] = cures.added_mass && cures.added_mass->reached
                                 ? Json(cures.added_mass->total)
                                 : Json(nullptr);
    }
    if (found.resolution) json["resolution"] = resolution_json(*found.resolution);
    json["seconds"] = {{"setup", found.setup}, {"analysis", found.analysis}};
    return json;
}

}  // namespace example
