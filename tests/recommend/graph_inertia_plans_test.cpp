// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/model/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/tradeoff/mode_probe.hpp>
#include <taut/recommend/recommend.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"

namespace taut_test::graph_inertia_plans_test {

using taut::Candidate;
using taut::Goal;
using taut::Method;
using taut::Plan;

namespace {

using taut::Index;
using Cloth = taut::SpringSystem<double, 3>;

constexpr Index side = 8;

/// A hanging cloth with the springs along its lowest row `times` stiffer.
Cloth hemmed(double times) {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    const Cloth plain = taut::hanging_cloth<double>(options);
    const auto start = plain.initial_state();
    Cloth cloth;
    for (Index i = 0; i < plain.size(); ++i) {
        cloth.add_particle(start.x.col(i), plain.mass(i));
        if (plain.is_pinned(i)) cloth.pin(i);
    }
    plain.visit_springs([&](auto spring) {
        const bool hem =
            std::min(spring.a, spring.b) >= side * (side - 1) && std::abs(spring.a - spring.b) == 1;
        if (hem) spring.parameters.stiffness *= times;
        cloth.add_spring(spring);
    });
    cloth.set_gravity(plain.gravity());
    return cloth;
}

std::vector<Plan> inertia_plans(const Cloth& cloth, const Goal& goal) {
    return taut::feasible_plans(cloth, goal, {Candidate{Method::graph_inertia}});
}

Goal accurate(double tolerance, double frequency) {
    Goal goal;
    goal.accuracy = taut::ModeTolerance{tolerance, tolerance};
    goal.up_to_frequency = frequency;
    return goal;
}

double ticking() {
    static double now = 0;
    return now += 1;
}

}  // namespace

TEST_CASE("slowed_mode_error: symplectic Euler of the heavier mode", "[tradeoff]") {
    Random random(931);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const double omega = std::exp2(random.uniform(-3, 6));
        const double h = random.uniform(0.01, 0.8) / omega;
        const double zeta = repeat % 3 == 0 ? 0 : random.uniform(0, 0.5);
        const double q = repeat % 5 == 0 ? 0 : random.uniform(0, 2);
        const auto error = taut::slowed_mode_error({omega, omega / std::sqrt(1 + q)}, h, zeta);
        if (q == 0) {
            const auto plain = taut::mode_error(Method::symplectic_euler, h * omega, zeta);
            CHECK(error.artificial_damping == plain.artificial_damping);
            CHECK_THAT(error.period_error, WithinAbs(plain.period_error, 1e-12));
        }
        // A = M̃ + ½hD_i and D_i at the default δ.
        const double delta = taut::GraphInertiaOptions{}.dissipation;
        const double a = 1 + (1 + delta) * q;
        const auto polynomial = taut::method::SymplecticEuler::step_quadratic(
            omega * omega / a, (2 * zeta * omega + 2 * delta * q / h) / a, h);
        const std::complex<double> half(polynomial.b / 2);
        const auto rate = std::log(-half + std::sqrt(half * half - polynomial.c)) / h;
        CHECK_THAT(error.artificial_damping, WithinAbs(-rate.real() / std::abs(rate) - zeta, 1e-9));
        CHECK_THAT(error.period_error,
                   WithinAbs(omega * std::sqrt(1 - zeta * zeta) / std::abs(rate.imag()) - 1, 1e-9));
    }
}

TEST_CASE("measured_mode_error: graph inertia slows a spring as its price says", "[tradeoff]") {
    Random random(932);
    for (int repeat = 0; repeat < 20; ++repeat) {
        taut::SpringSystem<double, 2> fork;
        const double stiffness = std::exp2(random.uniform(0, 10));
        fork.add_particle({0, 1}, std::exp2(random.uniform(-6, 0)));
        fork.add_particle({0, 0}, 1);
        fork.pin(1);
        fork.add_spring(0, 1, stiffness);
        const auto rest = fork.initial_state();
        const taut::Mode mode = taut::lowest_modes(fork, rest, 1).front();
        // Below the limit, 2 rad, no spring is implicit.
        const Candidate candidate{Method::graph_inertia, random.uniform(0.2, 4) / mode.omega};
        const auto shares =
            taut::graph_shares(fork, candidate.h, taut::GraphInertiaOptions{}.margin);
        const auto price = taut::inertia_price(fork, rest, shares, 1);
        const auto predicted = taut::slowed_mode_error(price.modes.front(), candidate.h);
        const auto measured = taut::measured_mode_error(fork, rest, mode, candidate, 1e-6);
        REQUIRE(measured);
        CHECK_THAT(measured->artificial_damping, WithinAbs(predicted.artificial_damping, 1e-5));
        CHECK_THAT(measured->period_error, WithinAbs(predicted.period_error, 1e-4));
    }
}

TEST_CASE("feasible_plans: graph inertia makes a stiff hem implicit, at an admitted price",
          "[tradeoff]") {
    for (const double times : {100.0, 1000.0}) {
        const Cloth cloth = hemmed(times);
        const auto start = cloth.initial_state();
        for (const Goal& goal : {Goal{}, accurate(0.02, 60), accurate(0.05, 400)}) {
            const auto explicit_steps =
                taut::feasible_plans(cloth, goal, {taut::recommended_candidates(goal).front()});
            const auto plans = inertia_plans(cloth, goal);
            REQUIRE_FALSE(plans.empty());
            CHECK(plans.size() <= 3);
            for (const Plan& plan : plans) {
                INFO(plan.substeps << " substeps, hem times " << times);
                const double h = plan.candidate.h;
                CHECK_THAT(h * static_cast<double>(plan.substeps), WithinRel(goal.frame, 1e-12));
                CHECK(plan.substeps < explicit_steps.front().substeps);
                const auto shares =
                    taut::graph_shares(cloth, h, taut::GraphInertiaOptions{}.margin);
                CHECK(shares.status == taut::Status::ok);
                CHECK(plan.inertia.implicit_springs == shares.implicit_springs());
                CHECK(plan.inertia.springs == cloth.spring_count());
                CHECK(plan.inertia.implicit_springs > 0);
                CHECK(2 * plan.inertia.implicit_springs <= plan.inertia.springs);
                const auto modes = taut::LowModes::of(cloth, start, 20);
                const auto price = taut::inertia_price(cloth, shares, modes, 10);
                CHECK_THAT(plan.inertia.added, WithinRel(price.added, 1e-9));
                double slowing = 0;
                for (const auto& mode : price.modes) {
                    slowing = std::max(slowing, -mode.change());
                    if (!goal.accuracy) {
                        CHECK(std::abs(taut::slowed_mode_error(mode, h).period_error) <= 0.05);
                    } else if (mode.frequency <= goal.up_to_frequency) {
                        CHECK(goal.accuracy->admits(taut::slowed_mode_error(mode, h)));
                    }
                }
                CHECK(plan.inertia.slowing >= slowing);
                if (goal.accuracy) CHECK(goal.accuracy->admits(plan.error));
            }
            // A step well above the largest makes too many springs implicit, or costs too much.
            const Plan& last = plans.back();
            const double h = 1.06 * last.candidate.h;
            const auto shares = taut::graph_shares(cloth, h, taut::GraphInertiaOptions{}.margin);
            if (last.bound == taut::StepBound::stability)
                CHECK(2 * shares.implicit_springs() > cloth.spring_count());
        }
    }
}

TEST_CASE("feasible_plans: no graph inertia where it has no place", "[tradeoff]") {
    // A regular cloth is explicit or all implicit.
    for (const Plan& plan : inertia_plans(hemmed(1), {}))
        CHECK(2 * plan.inertia.implicit_springs <= plan.inertia.springs);
    // What turns slack feeds it.
    const auto thread = taut::with_law<taut::TensionOnly>(hemmed(1000));
    CHECK(taut::feasible_plans(thread, {}, {Candidate{Method::graph_inertia}}).empty());
    Cloth held = hemmed(1000);
    for (Index i = 0; i < held.size(); ++i) held.pin(i);
    CHECK(inertia_plans(held, {}).empty());
    // No step is as accurate as that.
    CHECK(inertia_plans(hemmed(1000), accurate(1e-7, 60)).empty());
}

TEST_CASE("recommend: which springs implicit, where all steps cost the same", "[tradeoff]") {
    taut::Calibration calibration;
    calibration.clock = &ticking;
    const Goal goal;
    std::vector<Candidate> explicit_or_inertia = taut::recommended_candidates(goal);
    explicit_or_inertia.resize(2);
    const auto pick = [&](double times) {
        const Cloth cloth = hemmed(times);
        return taut::recommend(cloth, cloth.initial_state(), goal, explicit_or_inertia,
                               calibration);
    };
    const auto hem = pick(1000);
    CHECK(hem.pick.candidate.method == Method::graph_inertia);
    CHECK(hem.runner_up);
    const auto& inertia = hem.pick.inertia;
    CHECK(4 * inertia.implicit_springs < inertia.springs);
    const std::string made = "makes " + std::to_string(inertia.implicit_springs) + " of " +
                             std::to_string(inertia.springs) + " springs implicit, slowing";
    CHECK(missing(hem.why, {"graph inertia (", made.c_str(), "is the cheapest that is stable",
                            "next comes"}) == "");
}

TEST_CASE("recommend: graph inertia keeps its word when stepped", "[tradeoff]") {
    const Cloth cloth = hemmed(1000);
    for (const Plan& plan : inertia_plans(cloth, {})) {
        auto state = cloth.initial_state();
        taut::with_stepper(cloth, plan.candidate, [&](auto& stepper) {
            for (int frame = 0; frame < 120; ++frame)
                REQUIRE(stepper.step(state, plan.candidate.h, plan.substeps));
        });
        CHECK_THAT(state.time, WithinRel(2.0, 1e-9));
        CHECK(cloth.energy(state) < 0.05);  // it began at 0 J and has moved with 1 J
        CHECK(state.x.cwiseAbs().maxCoeff() < 2);
    }
}

}  // namespace taut_test::graph_inertia_plans_test
