// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <taut/integrator/adaptive.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/spring_system.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::adaptive_test {

using taut::Adaptive;

namespace {

using Springs = taut::SpringSystem<double, 2>;

/// Largest change of a spring's length, relative to rest.
double stretch_change(const Springs& system, const taut::State<double, 2>& a,
                      const taut::State<double, 2>& b) {
    double most = 0;
    const auto& set = system.springs();
    for (std::size_t s = 0; s < set.a.size(); ++s) {
        const auto length = [&](const auto& state) {
            return (state.x.col(set.b[s]) - state.x.col(set.a[s])).norm();
        };
        most = std::max(most, std::abs(length(a) - length(b)) / set.rest_length[s]);
    }
    return most;
}

/// A stepper that notes every state it was given and the step that was kept.
struct Spy {
    taut::ImplicitEuler<Springs>& stepper;
    const Springs& system;
    double worst_kept = 0;
    taut::State<double, 2> start{};
    taut::State<double, 2> end{};
    int calls = 0;

    taut::Report step(taut::State<double, 2>& state, double h) {
        if (calls++ > 0 && same_bits(state, end)) {  // the last step was kept
            worst_kept = std::max(worst_kept, stretch_change(system, start, end));
        }
        start = state;
        const taut::Report report = stepper.step(state, h);
        end = state;
        return report;
    }
};

}  // namespace

TEST_CASE("adaptive: no kept step changes a length by more than the limit, and h grows again",
          "[integrator]") {
    Random random(1);
    RandomOptions options;
    options.rayleigh = true;
    auto system = random_system<double, 2>(random, options);
    system.set_rayleigh({5, 0.05});
    auto state = random_state(random, system);
    for (Index i = 0; i < 2; ++i) state.v.col(i).setZero();  // the pinned ones
    taut::ImplicitEuler stepper(system);
    Spy spy{stepper, system};
    Adaptive<Spy, Springs>::Options limits;
    limits.max_stretch_change = 0.05;
    Adaptive adaptive(system, spy, limits);
    const auto crumpled = adaptive.advance(state, 0.5);
    REQUIRE(crumpled);
    CHECK(crumpled.rejected > 0);
    CHECK(crumpled.spring >= 0);
    CHECK(spy.worst_kept <= 0.05);
    CHECK_THAT(state.time, WithinRel(0.5, Tolerance<double>::accumulated));
    CHECK(crumpled.steps + crumpled.rejected == spy.calls);
    REQUIRE(adaptive.advance(state, 10));  // it calms down
    CHECK_THAT(adaptive.advance(state, 1).h, WithinRel(limits.max_step, 1e-12));
}

TEST_CASE("adaptive: a duration that is no multiple of the step is met exactly", "[integrator]") {
    Random random(2);
    const auto system = random_system<double, 2>(random);
    auto state = system.initial_state();
    taut::ImplicitEuler stepper(system);
    Adaptive<taut::ImplicitEuler<Springs>, Springs>::Options limits;
    limits.max_stretch_change = 1e9;
    limits.max_step = 0.01;
    Adaptive adaptive(system, stepper, limits);
    const auto report = adaptive.advance(state, 0.035);
    REQUIRE(report);
    CHECK(report.steps == 4);
    CHECK(report.advanced == 0.035);
    auto expected = system.initial_state();
    taut::ImplicitEuler plain(system);
    REQUIRE(plain.step(expected, 0.01, 3));
    REQUIRE(plain.step(expected, 0.035 - 0.03));
    CHECK(distance(state.x, expected.x) <= Tolerance<double>::rounding);
}

TEST_CASE("adaptive: an explicit step beyond its limit is halved until it holds", "[integrator]") {
    auto system = Springs();
    for (int i = 0; i < 5; ++i) {
        system.add_particle({0.1 * i, 0}, 1e-4);
        if (i > 0) system.add_spring(i - 1, i, 1000);
    }
    system.pin(0);
    system.set_gravity({0, -9.81});
    auto state = system.initial_state();
    taut::SymplecticEuler stepper(system);
    Adaptive adaptive(system, stepper);
    REQUIRE(adaptive.advance(state, 0.1));
    CHECK(state.finite());
    CHECK((state.x - system.initial_state().x).cwiseAbs().maxCoeff() < 1);
}

TEST_CASE("adaptive: a failure at the smallest step is reported, with the last good state",
          "[integrator][bad_input]") {
    Random random(3);
    auto system = random_system<double, 2>(random);
    system.set_external_force([](const auto& s, auto& f) {
        if (s.time > 0.05) f.col(4).setConstant(std::numeric_limits<double>::quiet_NaN());
    });
    auto state = system.initial_state();
    taut::SymplecticEuler stepper(system);
    Adaptive adaptive(system, stepper);
    const auto report = adaptive.advance(state, 1);
    CHECK_FALSE(report);
    CHECK(report.status == taut::Status::diverged);
    CHECK(report.where == 4);
    CHECK(state.finite());
    CHECK_THAT(state.time, WithinAbs(0.05, 1e-4));
    CHECK_THAT(report.advanced, WithinRel(state.time, Tolerance<double>::accumulated));

    state.v(0, 3) = std::nan("");
    CHECK(adaptive.advance(state, 1).status == taut::Status::invalid_state);
    for (const double bad : {0.0, -1.0, std::nan("")}) {
        CHECK(adaptive.advance(state, bad).status == taut::Status::invalid_step);
    }
}

TEST_CASE("adaptive: options out of range are refused by name", "[integrator][bad_input]") {
    Random random(4);
    const auto system = random_system<double, 2>(random);
    taut::SymplecticEuler stepper(system);
    using Kind = Adaptive<decltype(stepper), std::decay_t<decltype(system)>>;
    const auto message = [&](auto change) {
        Kind::Options options;
        change(options);
        return message_of([&] { Kind(system, stepper, options); });
    };
    CHECK(missing(message([](auto& o) { o.max_step = 0; }), {"Adaptive", "max_step is 0"}) == "");
    CHECK(missing(message([](auto& o) { o.min_step = 1; }), {"Adaptive", "min_step is 1"}) == "");
    CHECK(missing(message([](auto& o) { o.max_stretch_change = -1; }), {"max_stretch_change"}) ==
          "");
    CHECK(missing(message([](auto& o) { o.successes = 0; }), {"successes is 0"}) == "");
    CHECK(message([](auto&) {}) == "");
}

}  // namespace taut_test::adaptive_test
