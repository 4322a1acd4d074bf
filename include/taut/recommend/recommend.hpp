// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the modules accuracy, bdf2.

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "../proof/any_pose.hpp"
#include "../proof/energy_limit.hpp"
#include "../proof/rayleigh.hpp"
#include "choose.hpp"
#include "cost.hpp"

namespace taut {

/// What recommend() compares: the energy-stable Euler step, and implicit Euler with both solvers;
/// BDF2 with both where accuracy is asked for, and not where stability is all that counts, for one
/// of its linearised steps may gain energy.
inline std::vector<Candidate> recommended_candidates(const Goal& goal) {
    // What is left of a linear solve must not blur the mode errors that the goal admits.
    const double tolerance = goal.accuracy ? 1e-6 : 1e-3;
    std::vector<Candidate> candidates;
    candidates.push_back({Method::energy_stable_euler});
    for (const Method method : {Method::implicit_euler, Method::bdf2}) {
        if (method == Method::bdf2 && !goal.accuracy) continue;
        for (const auto solver : {LinearSolver::conjugate_gradient, LinearSolver::direct}) {
            candidates.push_back({method, 0, solver, tolerance});
        }
    }
    return candidates;
}

/// Explicit or implicit? The plans that reach a goal, without their costs: energy-stable steps at
/// energy_limit [T42], other explicit ones, linearised, at half of any_pose_limit [T23]; implicit
/// ones, linearised stable at any pose, as large as the frame; and none above its accurate_step
/// [T25]. The damping that accuracy is predicted with is
/// the scene's Rayleigh damping; dampers on springs are not in it.
template <class Scalar, int Dim, class... Laws>
std::vector<Plan> feasible_plans(const SpringSystem<Scalar, Dim, Laws...>& system, const Goal& goal,
                                 const std::vector<Candidate>& candidates) {
    double zeta = 0;
    if (goal.accuracy) {
        require_positive("recommend", "Goal::up_to_frequency", goal.up_to_frequency);
        // An overdamped mode has no period to err in: judge by the strongest damping with one.
        zeta = (std::min)(0.95, damping_ratio(system.rayleigh(), goal.up_to_frequency));
    }
    const auto limit = static_cast<double>(any_pose_limit(system).certified);
    std::vector<Plan> plans;
    for (const Candidate& candidate : candidates) {
        const method::AnyPose safe = method::any_pose(candidate.method);
        if (safe == method::AnyPose::every_step) {
            plans.push_back(
                plan_for(candidate, std::numeric_limits<double>::infinity(), goal, zeta));
        } else if (safe == method::AnyPose::limited && limit > 0) {
            plans.push_back(plan_for(candidate, limit / 2, goal, zeta));
        } else if (safe == method::AnyPose::proved) {
            const auto proved = static_cast<double>(energy_limit(system).certified);
            if (proved > 0) plans.push_back(plan_for(candidate, proved, goal, zeta));
        }
    }
    return plans;
}

namespace tradeoff_detail {

/// Measures the cost of each plan by a few steps from `state`, s a frame.
template <class System>
void measure_costs(const System& system, const typename System::State& state,
                   const Calibration& calibration, std::vector<Plan>& plans) {
    // A factorisation of a large scene takes seconds: one step shows that it is far behind.
    constexpr double too_dear = 5;
    double least = std::numeric_limits<double>::infinity();
    for (Plan& plan : plans) {
        const auto substeps = static_cast<double>(plan.substeps);
        plan.cost = substeps * step_cost(system, state, plan.candidate, calibration,
                                         too_dear * least / substeps);
        least = (std::min)(least, plan.cost);
    }
}

}  // namespace tradeoff_detail

/// The integrator, solver, step and substeps that reach a goal at the least cost on this machine:
/// feasible_plans(), each timed by a few steps from `state` on a copy, then choose().
///
///     taut::Goal goal;                                  // 1/60 s a frame, stable is enough
///     auto advice = taut::recommend(cloth, state, goal);
///     advice.pick.candidate.h, advice.why
///
/// Costs are those of the code as compiled and of the machine as busy as it is; everything else is
/// deterministic.
/// @throws (fail) what feasible_plans() and choose() refuse
template <class Scalar, int Dim, class... Laws>
Recommendation recommend(const SpringSystem<Scalar, Dim, Laws...>& system,
                         const State<Scalar, Dim>& state, const Goal& goal,
                         const std::vector<Candidate>& candidates,
                         const Calibration& calibration = {}) {
    std::vector<Plan> plans = feasible_plans(system, goal, candidates);
    tradeoff_detail::measure_costs(system, state, calibration, plans);
    return choose(std::move(plans), goal);
}

/// The same among recommended_candidates(goal).
template <class Scalar, int Dim, class... Laws>
Recommendation recommend(const SpringSystem<Scalar, Dim, Laws...>& system,
                         const State<Scalar, Dim>& state, const Goal& goal,
                         const Calibration& calibration = {}) {
    return recommend(system, state, goal, recommended_candidates(goal), calibration);
}

}  // namespace taut
