// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <chrono>
#include <limits>
#include <taut/recommend/recommend.hpp>
#include <vector>

#include "lab.hpp"
#include "scene.hpp"

namespace {

struct Advice {
    lab::Cloth::State state;  // from which plans are timed
    std::vector<taut::Plan> plans;
};

Advice advice;
LabPlan answer{};

/// CPU time would do, but a browser has none to tell; and std::clock() wraps there.
double seconds_now() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
}

/// The scene some frames after its start, the same at every load: at rest, linear systems would
/// be easier than they are.
lab::Cloth::State moving_state() {
    const auto& cloth = lab::scene().cloth;
    constexpr double frame = 1.0 / 60;
    const taut::Index frames = std::clamp<taut::Index>(20'000 / cloth.size(), 1, 20);
    auto state = cloth.initial_state();
    taut::Candidate candidate;
    candidate.method = taut::Method::implicit_euler;
    candidate.solver = taut::LinearSolver::conjugate_gradient;
    const bool moved = [&] {
        bool good = true;
        taut::with_stepper(cloth, candidate, [&](auto& stepper) {
            good = static_cast<bool>(stepper.step(state, frame, frames));
        });
        return good;
    }();
    return moved ? state : cloth.initial_state();
}

}  // namespace

int lab_advise() {
    constexpr taut::Index most_direct = 10'000;  // particles: a factorisation takes gigabytes
    const auto& cloth = lab::scene().cloth;
    advice.plans.clear();
    if (cloth.pinned_count() == cloth.size()) return 0;
    advice.state = moving_state();
    const taut::Goal goal;
    auto candidates = taut::recommended_candidates(goal);
    if (cloth.size() > most_direct) {
        candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                        [](const taut::Candidate& candidate) {
                                            return taut::is_implicit(candidate.method) &&
                                                   candidate.solver == taut::LinearSolver::direct;
                                        }),
                         candidates.end());
    }
    advice.plans = taut::feasible_plans(cloth, goal, candidates);
    return static_cast<int>(advice.plans.size());
}

void lab_time_plan(int i, double seconds) {
    constexpr double far = 5;  // times the least cost: one step shows it
    double least = std::numeric_limits<double>::infinity();
    for (const auto& plan : advice.plans) least = std::min(least, plan.cost);
    taut::Calibration calibration;
    calibration.seconds = seconds;
    calibration.least_steps = 1;
    calibration.clock = &seconds_now;
    taut::Plan& plan = advice.plans[static_cast<std::size_t>(i)];
    const auto substeps = static_cast<double>(plan.substeps);
    const double cost = taut::step_cost(lab::scene().cloth, advice.state, plan.candidate,
                                        calibration, far * least / substeps);
    plan.cost = std::min(plan.cost, substeps * cost);
}

const LabPlan* lab_plan(int i) {
    const taut::Plan& plan = advice.plans[static_cast<std::size_t>(i)];
    const taut::Method method = plan.candidate.method;
    const bool gradients = plan.candidate.solver == taut::LinearSolver::conjugate_gradient;
    answer = {static_cast<double>(method), is_implicit(method) && gradients ? 1.0 : 0.0,
              static_cast<double>(plan.substeps), plan.candidate.h, plan.cost};
    return &answer;
}
