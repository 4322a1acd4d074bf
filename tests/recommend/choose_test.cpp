// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/recommend/choose.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"

namespace taut_test::choose_test {

using taut::Candidate;
using taut::choose;
using taut::Goal;
using taut::Method;
using taut::Plan;
using taut::plan_for;
using taut::StepBound;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Method methods[] = {Method::symplectic_euler, Method::implicit_euler, Method::bdf2};

}  // namespace

TEST_CASE("plan_for: whole steps fill the frame, none above what is safe and accurate",
          "[tradeoff]") {
    Random random(911);
    for (int repeat = 0; repeat < 300; ++repeat) {
        Goal goal;
        goal.frame = std::exp2(random.uniform(-8, 0));
        const double safe =
            repeat % 4 == 0 ? infinity : goal.frame * std::exp2(random.uniform(-12, 3));
        if (repeat % 2 == 0) {
            goal.accuracy =
                taut::ModeTolerance{random.uniform(0.001, 0.3), random.uniform(0.001, 0.3)};
            goal.up_to_frequency = std::exp2(random.uniform(-2, 12));
        }
        for (const Method method : methods) {
            const Plan plan = plan_for(Candidate{method}, safe, goal);
            const double h = plan.candidate.h;
            CHECK_THAT(h * static_cast<double>(plan.substeps), WithinRel(goal.frame, 1e-12));
            CHECK(h <= safe);
            double usable = safe;
            if (goal.accuracy) {
                usable = std::min(
                    safe, taut::accurate_step(method, *goal.accuracy, goal.up_to_frequency));
                CHECK(goal.accuracy->admits(plan.error));
            }
            // One step fewer would be too large.
            if (plan.substeps > 1) {
                CHECK(goal.frame / static_cast<double>(plan.substeps - 1) > usable * (1 - 1e-12));
            }
            CHECK((plan.bound == StepBound::frame) == (usable >= goal.frame));
            if (plan.bound == StepBound::stability) CHECK(usable == safe);
            if (plan.bound == StepBound::accuracy) CHECK(usable < safe);
        }
    }
}

TEST_CASE("choose: the cheapest plan, whatever their order", "[tradeoff]") {
    Random random(912);
    const Goal goal;
    for (int repeat = 0; repeat < 100; ++repeat) {
        std::vector<Plan> plans;
        for (const Method method : methods) {
            Plan plan = plan_for(Candidate{method}, 1e-3, goal);
            plan.cost = random.uniform(0.1, 2);
            plans.push_back(plan);
        }
        plans[static_cast<std::size_t>(random.below(3))].cost = infinity;  // it failed
        const auto answer = choose(plans, goal);
        REQUIRE(answer.plans.size() == 2);
        REQUIRE(answer.runner_up);
        for (const Plan& plan : plans) CHECK(answer.pick.cost <= plan.cost);
        CHECK(answer.pick.cost <= answer.runner_up->cost);
        CHECK(answer.runner_up->cost < infinity);
        CHECK(missing(answer.why, {name(answer.pick.candidate.method),
                                   name(answer.runner_up->candidate.method), "stable"}) == "");
        std::reverse(plans.begin(), plans.end());
        CHECK(choose(plans, goal).why == answer.why);
    }
}

TEST_CASE("choose: a budget that is not kept is said", "[tradeoff]") {
    Goal goal;
    goal.budget = 2e-3;
    Plan plan = plan_for(Candidate{Method::implicit_euler}, infinity, goal);
    plan.cost = 1e-3;
    const auto kept = choose({plan}, goal);
    CHECK(kept.within_budget);
    CHECK_FALSE(kept.runner_up);
    CHECK(kept.why.find("budget") == std::string::npos);
    plan.cost = 3e-3;
    const auto broken = choose({plan}, goal);
    CHECK_FALSE(broken.within_budget);
    CHECK(missing(broken.why, {"implicit_euler", "3 ms", "budget of 2 ms"}) == "");
}

TEST_CASE("choose: wrong input is named", "[tradeoff]") {
    const Goal goal;
    CHECK(missing(message_of([&] { (void)choose({}, goal); }), {"no plan has a finite cost"}) ==
          "");
    CHECK(missing(message_of([&] { (void)plan_for(Candidate{}, 0, goal); }), {"safe is 0"}) == "");
    Goal none;
    none.frame = 0;
    CHECK(missing(message_of([&] { (void)plan_for(Candidate{}, 1, none); }),
                  {"Goal::frame is 0"}) == "");
}

}  // namespace taut_test::choose_test
