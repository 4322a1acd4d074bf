// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <set>
#include <string>
#include <taut/scene/cloth.hpp>
#include <taut/stability/stability.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::step_limit_test {

using taut::StepLimit;

namespace {

template <class Scalar>
taut::SpringSystem<Scalar, 2> pair() {
    taut::SpringSystem<Scalar, 2> system;
    system.add_particle({0, 0}, 1);
    system.add_particle({1, 0}, 1);
    system.add_spring(0, 1, 10);
    return system;
}

template <class Scalar>
StepLimit<Scalar> limit_of(const taut::SpringSystem<Scalar, 2>& system, Scalar certified) {
    StepLimit<Scalar> limit;
    limit.certified = certified;
    limit.refuted = 2 * certified;
    limit.revision = system.revision();
    return limit;
}

}  // namespace

TEMPLATE_TEST_CASE("step_limit: step_for is safety times certified, or nothing", "[stability]",
                   float, double, long double) {
    using Limits = std::numeric_limits<TestType>;
    const auto system = pair<TestType>();
    const auto limit = limit_of<TestType>(system, TestType(0.25));
    for (const TestType safety : {Limits::min(), TestType(0.5), TestType(0.9), TestType(1)}) {
        const auto step = limit.step_for(system, safety);
        REQUIRE(step.has_value());
        CHECK(*step == safety * TestType(0.25));
        CHECK(*step <= limit.certified);
    }
    for (const TestType safety :
         {TestType(0), TestType(-0.5), std::nextafter(TestType(1), TestType(2)), TestType(2),
          Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()}) {
        CHECK_FALSE(limit.step_for(system, safety).has_value());
    }
    CHECK_FALSE(limit_of<TestType>(system, 0).step_for(system, TestType(0.9)).has_value());
    CHECK_FALSE(limit_of<TestType>(system, Limits::quiet_NaN())
                    .step_for(system, TestType(0.9))
                    .has_value());
    const auto unbounded = limit_of<TestType>(system, Limits::infinity());
    CHECK(unbounded.unbounded());
    CHECK_FALSE(limit.unbounded());
    REQUIRE(unbounded.step_for(system, TestType(0.9)).has_value());
    CHECK(*unbounded.step_for(system, TestType(0.9)) == Limits::infinity());
    // Nothing is proved by default.
    CHECK_FALSE(StepLimit<TestType>{}
                    .step_for(taut::SpringSystem<TestType, 2>{}, TestType(0.9))
                    .has_value());
}

TEST_CASE("step_limit: a stale revision is refused, whatever changed", "[stability]") {
    const auto stale = [](auto&& change) {
        auto system = pair<double>();
        const auto limit = limit_of(system, 0.25);
        REQUIRE(limit.step_for(system, 0.9).has_value());
        change(system);
        return !limit.step_for(system, 0.9).has_value();
    };
    CHECK(stale([](auto& s) { s.add_spring(0, 1, 1); }));
    CHECK(stale([](auto& s) { s.set_mass(0, 2); }));
    CHECK(stale([](auto& s) { s.pin(0); }));
    CHECK(stale([](auto& s) { s.pin(0), s.unpin(0); }));
    CHECK(stale([](auto& s) { s.set_rayleigh({0.1, 0}); }));
    // Gravity and external forces are no part of a step limit, nor is pinning what is pinned.
    CHECK_FALSE(stale([](auto& s) { s.set_gravity({0, -9.81}); }));
    CHECK_FALSE(stale([](auto& s) { s.set_external_force([](const auto&, auto&) {}); }));
    CHECK_FALSE(stale([](auto& s) { s.unpin(0); }));
}

TEST_CASE("step_limit: rounding to Scalar never lifts a certified step, nor lowers a refuted one",
          "[stability]") {
    using taut::stability_detail::round_down;
    using taut::stability_detail::round_up;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Random random(1200);
    for (int repeat = 0; repeat < 5000; ++repeat) {
        // Full 53 bits, from denormal floats to huge ones.
        const double value = (1 + random.uniform(0, 1) + random.uniform(0, 1) * 0x1p-24) *
                             std::exp2(std::round(random.uniform(-150, 120)));
        const float down = round_down<float>(value);
        const float up = round_up<float>(value);
        CHECK(static_cast<double>(down) <= value);
        CHECK(static_cast<double>(up) >= value);
        if (value > 1e-37) {
            CHECK(static_cast<double>(down) >= value * (1 - 0x1p-21));
            CHECK(static_cast<double>(up) <= value * (1 + 0x1p-21));
            // Room for three roundings to float of what a stepper multiplies by.
            CHECK(static_cast<double>(down) <= value * (1 - 3 * 0x1p-24));
            CHECK(static_cast<double>(up) >= value * (1 + 3 * 0x1p-24));
        }
        // In double there is still the room for the arithmetic that made it.
        CHECK(round_down<double>(value) < value);
        CHECK(round_up<double>(value) > value);
        CHECK(round_down<double>(value) >= value * (1 - 1e-14));
        CHECK(round_up<double>(value) <= value * (1 + 1e-14));
    }
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(round_down<double>(nan) == 0);
    CHECK(round_up<double>(nan) == infinity);
    CHECK(round_down<float>(0) == 0);
    CHECK(round_down<double>(0) == 0);
    CHECK(round_down<float>(infinity) == std::numeric_limits<float>::infinity());
    CHECK(round_up<float>(infinity) == std::numeric_limits<float>::infinity());
    // Beyond float's range: below, the largest float; above, infinity.
    CHECK(static_cast<double>(round_down<float>(1e39)) <= 1e39);
    CHECK(std::isfinite(round_down<float>(1e39)));
    CHECK(round_up<float>(1e39) == std::numeric_limits<float>::infinity());
    CHECK(round_down<float>(1e-60) == 0);
    CHECK(round_up<float>(1e-60) > 0);
}

TEST_CASE("step_limit: names of causes and methods are their own", "[stability]") {
    using taut::Cause;
    std::set<std::string> names;
    for (const Cause cause : {Cause::stiffness, Cause::damping, Cause::undamped,
                              Cause::undamped_modes, Cause::unconditional, Cause::nothing_to_limit,
                              Cause::buckling, Cause::damping_unproved, Cause::rounding}) {
        names.insert(name(cause));
    }
    CHECK(names.size() == 9);
    CHECK(names.count("unknown") == 0);
}

TEST_CASE("step_limit: after update() the limit is that of a new analysis, and holds again",
          "[stability]") {
    auto cloth = taut::hanging_cloth<double>({16, 14});
    auto state = cloth.initial_state();
    taut::Stability<double> stability(cloth, state);
    const auto method = taut::Method::symplectic_euler;
    const auto check = [&](const char* change) {
        INFO(change);
        stability.update(cloth, state);
        const auto limit = stability.max_step(method);
        const auto anew = taut::Stability<double>(cloth, state).max_step(method);
        CHECK(limit.step_for(cloth, 1.0).has_value());
        // Two brackets of one truth.
        CHECK(limit.certified < anew.refuted);
        CHECK(anew.certified < limit.refuted);
        CHECK(limit.refuted / limit.certified < 1.06);
        CHECK(stability.size() == 3 * (cloth.size() - cloth.pinned_count()));
    };
    cloth.add_spring(30, 45, 1e6);
    check("a spring added");
    cloth.add_spring(150, 165, 1e7);  // the mode of the last one is still there, and leads no more
    check("a stiffer one elsewhere");
    cloth.set_mass(100, 1e-5);
    check("a lighter particle");
    cloth.pin(7);
    check("a pin added");
    state.x *= 1.02;
    check("another pose");
}

}  // namespace taut_test::step_limit_test
