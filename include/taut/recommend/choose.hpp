// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "../accuracy/accuracy.hpp"
#include "candidate.hpp"

// The choice among integrators once their costs are known [T25]: no clock in here.

namespace taut {

/// What a scene is simulated for.
struct Goal {
    double frame = 1.0 / 60;                ///< s; steps divide it evenly
    std::optional<ModeTolerance> accuracy;  ///< none: stable is enough
    double up_to_frequency = 0;             ///< rad/s: the modes that `accuracy` is about
    double budget = std::numeric_limits<double>::infinity();  ///< CPU s a frame
};

/// What keeps a step from being larger.
enum class StepBound { stability, accuracy, frame };

/// One way to reach a goal.
struct Plan {
    Candidate candidate;
    Index substeps = 1;  ///< a frame; candidate.h is frame/substeps
    StepBound bound = StepBound::frame;
    ModeError error;  ///< predicted at Goal::up_to_frequency; 0 without a goal of accuracy
    double cost = std::numeric_limits<double>::infinity();  ///< CPU s a frame; infinity: it fails
};

/// The usable step of one candidate, h = min(safe h, accurate h) [T25], as an even part of the
/// frame.
/// @param safe  s, > 0; infinity if every step is
/// @param zeta  the damping ratio, in [0, 1), of the scene's own mode at Goal::up_to_frequency
inline Plan plan_for(Candidate candidate, double safe, const Goal& goal, double zeta = 0) {
    require_positive("plan_for", "Goal::frame", goal.frame);
    if (!(safe > 0)) fail("plan_for: safe is ", safe, "; it must be > 0");
    const double infinity = std::numeric_limits<double>::infinity();
    const double accurate =
        goal.accuracy ? accurate_step(candidate.method, *goal.accuracy, goal.up_to_frequency, zeta)
                      : infinity;
    Plan plan;
    const double usable = (std::min)(safe, accurate);
    if (usable < goal.frame)
        plan.bound = safe <= accurate ? StepBound::stability : StepBound::accuracy;
    const double count = (std::max)(1.0, std::ceil(goal.frame / usable));
    if (count > 1e15)
        fail("plan_for: a frame of ", goal.frame, " s holds ", count, " steps of ", usable, " s");
    plan.substeps = static_cast<Index>(count);
    candidate.h = goal.frame / count;
    plan.candidate = candidate;
    if (goal.accuracy) {
        plan.error = mode_error(candidate.method, candidate.h * goal.up_to_frequency, zeta);
    }
    return plan;
}

/// The answer of recommend() and choose().
struct Recommendation {
    Plan pick;
    std::optional<Plan> runner_up;
    bool within_budget = true;
    std::string why;          ///< one sentence
    std::vector<Plan> plans;  ///< all that were compared, the cheapest first
};

namespace tradeoff_detail {

inline std::string milliseconds(double seconds) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.3g ms", 1e3 * seconds);
    return buffer;
}
inline std::string describe(const Plan& plan) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, " (%lld x %.3g s, ", static_cast<long long>(plan.substeps),
                  plan.candidate.h);
    return name(plan.candidate) + buffer + milliseconds(plan.cost) + " a frame)";
}
constexpr const char* reason(StepBound bound) {
    switch (bound) {
        case StepBound::stability: return "its largest safe step";
        case StepBound::accuracy: return "its largest accurate step";
        case StepBound::frame: return "the whole frame in one step";
    }
    return "unknown";
}

}  // namespace tradeoff_detail

/// The cheapest of plans that all reach the goal. Fails when none has a finite cost.
inline Recommendation choose(std::vector<Plan> plans, const Goal& goal) {
    plans.erase(std::remove_if(plans.begin(), plans.end(),
                               [](const Plan& plan) { return !detail::is_finite(plan.cost); }),
                plans.end());
    if (plans.empty()) fail("choose: no plan has a finite cost; at least one is needed");
    std::stable_sort(plans.begin(), plans.end(),
                     [](const Plan& a, const Plan& b) { return a.cost < b.cost; });
    Recommendation answer;
    answer.pick = plans.front();
    if (plans.size() > 1) answer.runner_up = plans[1];
    answer.within_budget = answer.pick.cost <= goal.budget;
    answer.why = tradeoff_detail::describe(answer.pick) + " takes " +
                 tradeoff_detail::reason(answer.pick.bound) + " and is the cheapest that is " +
                 (goal.accuracy ? "accurate enough" : "stable");
    if (answer.runner_up) {
        char ratio[32];
        std::snprintf(ratio, sizeof ratio, "%.3g times", answer.runner_up->cost / answer.pick.cost);
        answer.why += "; next comes " + tradeoff_detail::describe(*answer.runner_up) + " at " +
                      ratio + " the cost with " + tradeoff_detail::reason(answer.runner_up->bound);
    }
    if (!answer.within_budget) {
        answer.why += "; none keeps to the budget of " + tradeoff_detail::milliseconds(goal.budget);
    }
    answer.why += '.';
    answer.plans = std::move(plans);
    return answer;
}

}  // namespace taut
