// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <string>
#include <taut/network/tension_only.hpp>
#include <taut/lattice/chain.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/recommend/recommend.hpp>

#include "../support/catch.hpp"
#include "../support/faults.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"

namespace taut_test::recommend_test {

using taut::Candidate;
using taut::Goal;
using taut::Method;

namespace {

using taut::Index;
using Cloth = taut::SpringSystem<double, 3>;

Cloth cloth(double stiffness) {
    taut::ClothOptions options;
    options.rows = options.columns = 5;
    options.stretch = stiffness;
    options.bend = stiffness / 10;
    return taut::hanging_cloth<double>(options);
}

/// A clock that ticks once a look: every batch of steps takes one second by it.
double ticking() {
    static double now = 0;
    return now += 1;
}

/// A short look at the clock, where any answer will do.
const taut::Calibration brief{0.002};

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Method methods[] = {Method::symplectic_euler, Method::implicit_euler, Method::bdf2};

}  // namespace

TEST_CASE("plan_for: whole steps fill the frame, none above what is safe and accurate",
          "[recommend]") {
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
            CAPTURE(repeat, taut::name(method));
            const taut::Plan plan = taut::plan_for(Candidate{method}, safe, goal);
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
            CHECK((plan.bound == taut::StepBound::frame) == (usable >= goal.frame));
            if (plan.bound == taut::StepBound::stability) CHECK(usable == safe);
            if (plan.bound == taut::StepBound::accuracy) CHECK(usable < safe);
        }
    }
}

TEST_CASE("choose: the cheapest plan, whatever their order", "[recommend]") {
    Random random(912);
    const Goal goal;
    for (int repeat = 0; repeat < 100; ++repeat) {
        std::vector<taut::Plan> plans;
        for (const Method method : methods) {
            taut::Plan plan = taut::plan_for(Candidate{method}, 1e-3, goal);
            plan.cost = random.uniform(0.1, 2);
            plans.push_back(plan);
        }
        plans[static_cast<std::size_t>(random.below(3))].cost = infinity;  // it failed
        CAPTURE(repeat);
        const auto answer = taut::choose(plans, goal);
        REQUIRE(answer.plans.size() == 2);
        REQUIRE(answer.runner_up);
        for (const taut::Plan& plan : plans) CHECK(answer.pick.cost <= plan.cost);
        CHECK(answer.pick.cost <= answer.runner_up->cost);
        CHECK(answer.runner_up->cost < infinity);
        CHECK(missing(answer.why, {name(answer.pick.candidate.method),
                                   name(answer.runner_up->candidate.method), "stable"}) == "");
        std::reverse(plans.begin(), plans.end());
        CHECK(taut::choose(plans, goal).why == answer.why);
    }
}

TEST_CASE("choose: a budget that is not kept is said", "[recommend]") {
    Goal goal;
    goal.budget = 2e-3;
    taut::Plan plan = taut::plan_for(Candidate{Method::implicit_euler}, infinity, goal);
    plan.cost = 1e-3;
    const auto kept = taut::choose({plan}, goal);
    CHECK(kept.within_budget);
    CHECK_FALSE(kept.runner_up);
    CHECK(kept.why.find("budget") == std::string::npos);
    plan.cost = 3e-3;
    const auto broken = taut::choose({plan}, goal);
    CHECK_FALSE(broken.within_budget);
    CHECK(missing(broken.why, {"implicit_euler", "3 ms", "budget of 2 ms"}) == "");
}

TEST_CASE("feasible_plans: explicit steps cannot gain energy, all are accurate", "[recommend]") {
    Goal goal;
    goal.accuracy = taut::ModeTolerance{0.03, 0.03};
    for (const double frequency : {1.0, 30.0, 400.0}) {
        goal.up_to_frequency = frequency;
        for (const double stiffness : {10.0, 1e4, 1e7}) {
            const Cloth scene = cloth(stiffness);
            const auto limit = taut::energy_limit(scene);
            auto candidates = taut::recommended_candidates(goal);
            CHECK(candidates.size() == 5);
            candidates.push_back({Method::symplectic_euler});
            candidates.push_back({Method::velocity_verlet});
            const auto plans = taut::feasible_plans(scene, goal, candidates);
            CHECK(plans.size() == 7);
            for (const auto& plan : plans) {
                const Method method = plan.candidate.method;
                const double h = plan.candidate.h;
                INFO(name(plan.candidate) << ", h = " << h);
                CHECK_THAT(h * static_cast<double>(plan.substeps), WithinRel(goal.frame, 1e-12));
                if (method == Method::energy_stable_euler) {
                    CHECK(h <= limit.certified);
                } else if (!is_implicit(method)) {
                    // Half of the limit, but for what makes steps fill the frame.
                    const double half = taut::any_pose_limit(scene).certified / 2;
                    CHECK(h <= half);
                    if (plan.bound == taut::StepBound::stability)
                        CHECK(goal.frame / static_cast<double>(plan.substeps - 1) > half);
                }
                CHECK(goal.accuracy->admits(
                    taut::mode_error(plan.candidate.method, h * frequency, 0)));
            }
        }
    }
}

TEST_CASE("feasible_plans: the scene's damping counts", "[recommend]") {
    Goal goal;
    goal.accuracy = taut::ModeTolerance{0.03, 0.03};
    goal.up_to_frequency = 20;
    Cloth scene = cloth(1e5);
    scene.set_rayleigh({4, 0});  // a damping ratio of 0.1 at 20 rad/s
    for (const auto& plan : taut::feasible_plans(scene, goal, taut::recommended_candidates(goal))) {
        const auto expected = taut::mode_error(plan.candidate.method, plan.candidate.h * 20, 0.1);
        CHECK(plan.error.artificial_damping == expected.artificial_damping);
        CHECK(plan.error.period_error == expected.period_error);
        CHECK(goal.accuracy->admits(plan.error));
    }
    // A mode too damped to swing has plans all the same.
    scene.set_rayleigh({400, 0});
    CHECK(taut::feasible_plans(scene, goal, taut::recommended_candidates(goal)).size() == 5);
}

TEST_CASE("feasible_plans: the explicit plan keeps the energy of a net that only pulls",
          "[recommend]") {
    const auto net = taut::with_law<taut::TensionOnly>(cloth(1000));
    const auto plans = taut::feasible_plans(net, {}, taut::recommended_candidates({}));
    const taut::Plan& plan = plans.front();
    const Candidate& candidate = plan.candidate;
    REQUIRE(candidate.method == Method::energy_stable_euler);
    CHECK(plan.bound == taut::StepBound::stability);
    auto state = net.initial_state();
    const double energy = net.energy(state);
    taut::EnergyStableEuler stepper(net);
    double kinetic = 0;
    for (int frame = 0; frame < 600; ++frame) {
        REQUIRE(stepper.step(state, candidate.h, plan.substeps));
        kinetic = std::max(kinetic, net.kinetic_energy(state));
        REQUIRE(net.energy(state) <= energy + 1e-9 * kinetic);
    }
}

TEST_CASE("recommend: where all steps cost the same, the fewest win", "[recommend]") {
    taut::Calibration calibration;
    calibration.clock = &ticking;
    Goal stable;
    Goal accurate;
    accurate.accuracy = taut::ModeTolerance{};
    accurate.up_to_frequency = 100;
    for (const double stiffness : {1.0, 1e3, 1e6}) {
        const Cloth scene = cloth(stiffness);
        const auto start = scene.initial_state();
        for (const Goal& goal : {stable, accurate}) {
            const auto answer = taut::recommend(scene, start, goal, calibration);
            Index fewest = answer.pick.substeps;
            for (const auto& plan : answer.plans) fewest = std::min(fewest, plan.substeps);
            CHECK_THAT(answer.pick.cost, WithinRel(0.5 * static_cast<double>(fewest), 1e-12));
            CHECK(answer.pick.substeps == fewest);
            CHECK(answer.plans.size() == (goal.accuracy ? 5 : 3));
            CHECK(missing(answer.why, {"takes", "next comes"}) == "");
        }
        CHECK(start.x == scene.initial_state().x);
        CHECK(start.v == scene.initial_state().v);
    }
}

TEST_CASE("recommend: the pick keeps its word when stepped", "[recommend]") {
    Goal goal;
    for (const double stiffness : {10.0, 1e3, 1e6}) {
        const Cloth scene = cloth(stiffness);
        const auto answer = taut::recommend(scene, scene.initial_state(), goal, brief);
        auto state = scene.initial_state();
        taut::with_stepper(scene, answer.pick.candidate, [&](auto& stepper) {
            for (int frame = 0; frame < 60; ++frame) {
                REQUIRE(stepper.step(state, answer.pick.candidate.h, answer.pick.substeps));
            }
        });
        CHECK_THAT(state.time, WithinRel(1.0, 1e-9));
        CHECK(state.x.cwiseAbs().maxCoeff() < 10);
        CHECK(std::isfinite(answer.pick.cost));
        CHECK(answer.pick.cost > 0);
    }
}

TEST_CASE("recommend: scenes at the edge", "[recommend]") {
    Goal goal;
    Cloth dust;
    dust.add_particle({0, 0, 0}, 1);
    const auto alone = taut::recommend(dust, dust.initial_state(), goal, brief);
    CHECK(alone.pick.substeps == 1);  // nothing limits a step
    Cloth held = cloth(100);
    for (Index i = 0; i < held.size(); ++i) held.pin(i);
    CHECK(taut::recommend(held, held.initial_state(), goal, brief).pick.substeps == 1);
    const auto flat = taut::chain<float, 2>();
    CHECK(taut::recommend(flat, flat.initial_state(), goal, brief).plans.size() == 3);
    for (const Cloth& scene : {dust, held, cloth(100)}) {
        const auto ask = [&] { taut::recommend(scene, scene.initial_state(), goal, brief); };
        CHECK(faults_of(ask) == 0);
    }
}

TEST_CASE("step_cost: a step that fails costs infinity", "[recommend]") {
    const Cloth scene = cloth(100);
    taut::Calibration patient;
    patient.clock = &ticking;
    patient.seconds = 100;
    const auto cost = [&](double h) {
        return taut::step_cost(scene, scene.initial_state(), {Method::symplectic_euler, h},
                               patient);
    };
    CHECK(std::isinf(cost(-1)));
    CHECK(std::isinf(cost(10)));  // it diverges, after some batches
    patient.seconds = 3;
    CHECK(cost(1e-4) == 0.25);
}

TEST_CASE("recommend: bad input is named", "[recommend][bad_input]") {
    Goal goal;
    CHECK(missing(message_of([&] { (void)taut::choose({}, goal); }),
                  {"no plan has a finite cost"}) == "");
    CHECK(missing(message_of([&] { (void)taut::plan_for(Candidate{}, 0, goal); }), {"safe is 0"}) ==
          "");
    goal.accuracy = taut::ModeTolerance{};
    const Cloth scene = cloth(100);
    CHECK(missing(message_of([&] { (void)taut::recommend(scene, scene.initial_state(), goal); }),
                  {"Goal::up_to_frequency is 0"}) == "");
    goal = {};
    goal.frame = 0;
    CHECK(missing(message_of([&] { (void)taut::plan_for(Candidate{}, 1, goal); }),
                  {"Goal::frame is 0"}) == "");
}

}  // namespace taut_test::recommend_test
