// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/catch.hpp"
#include "../support/scene.hpp"

namespace taut_test::step_limit_test {

using taut::StepLimit;

namespace {

struct Revised {
    std::uint64_t number = 7;
    std::uint64_t revision() const { return number; }
};

template <class Scalar>
StepLimit<Scalar> limit_of(Scalar certified) {
    StepLimit<Scalar> limit;
    limit.certified = certified;
    limit.refuted = 2 * certified;
    limit.revision = 7;
    return limit;
}

}  // namespace

TEMPLATE_TEST_CASE("step_limit: step_for is safety times certified, or nothing", "[proof]", float,
                   double, long double) {
    using Limits = std::numeric_limits<TestType>;
    const Revised system;
    const auto limit = limit_of<TestType>(TestType(0.25));
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
    CHECK_FALSE(limit_of<TestType>(0).step_for(system, TestType(0.9)).has_value());
    CHECK_FALSE(
        limit_of<TestType>(Limits::quiet_NaN()).step_for(system, TestType(0.9)).has_value());
    const auto unbounded = limit_of<TestType>(Limits::infinity());
    CHECK(unbounded.unbounded());
    CHECK_FALSE(limit.unbounded());
    REQUIRE(unbounded.step_for(system, TestType(0.9)).has_value());
    CHECK(*unbounded.step_for(system, TestType(0.9)) == Limits::infinity());
    CHECK_FALSE(limit.step_for(Revised{8}, TestType(0.9)).has_value());
    // Nothing is proved by default.
    CHECK_FALSE(StepLimit<TestType>{}.step_for(Revised{0}, TestType(0.9)).has_value());
}

TEST_CASE("step_limit: a limit is void after each change that it says voids it", "[proof]") {
    for (const Kind& kind : all_kinds()) {
        INFO(kind);
        Random random(402);
        const auto original = random_scene(random, kind);
        const auto limits = {
            original.any_pose_limit(), original.energy_limit(), original.any_pose_limit(1e-3),
            original.energy_limit(1e-3),
            original.limit(taut::Method::symplectic_euler, original.initial_state())};
        const auto stale = [&](auto&& change) {
            auto scene = original;
            int count = 0;
            for (const auto& limit : limits) {
                REQUIRE(limit.step_for(scene, 0.9).has_value());
                CHECK(*limit.step_for(scene, 0.9) == 0.9 * limit.certified);
            }
            change(scene);
            for (const auto& limit : limits) count += !limit.step_for(scene, 0.9).has_value();
            return count;
        };
        AnySpring spring = original.springs()[0];
        CHECK(stale([&](Scene& s) { s.add_spring(spring); }) == 5);
        CHECK(stale([&](Scene& s) { s.remove_spring(spring.law, 0); }) == 5);
        CHECK(stale([](Scene& s) { s.set_mass(2, 0.1); }) == 5);
        CHECK(stale([](Scene& s) { s.unpin(0); }) == 5);
        CHECK(stale([](Scene& s) { s.pin(4), s.unpin(4); }) == 5);
        CHECK(stale([](Scene& s) { s.set_rayleigh(1, 0); }) == 5);
        // Gravity and external forces are no part of a step limit, nor is unpinning what is free.
        CHECK(stale([&](Scene& s) { s.set_gravity(Eigen::VectorXd::Ones(kind.dim)); }) == 0);
        CHECK(stale([](Scene& s) { s.set_external_force([](const auto&, auto&) {}); }) == 0);
        CHECK(stale([](Scene& s) { s.unpin(4); }) == 0);
    }
}

TEST_CASE("step_limit: rounding to Scalar never lifts a certified step, nor lowers a refuted one",
          "[proof]") {
    using taut::proof_detail::round_down;
    using taut::proof_detail::round_up;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Random random(1200);
    for (int repeat = 0; repeat < 2000; ++repeat) {
        // Full 53 bits, from denormal floats to huge ones.
        const double value = (1 + random.uniform(0, 1) + random.uniform(0, 1) * 0x1p-24) *
                             std::exp2(std::round(random.uniform(-150, 120)));
        const float down = round_down<float>(value);
        const float up = round_up<float>(value);
        CHECK(static_cast<double>(down) <= value);
        CHECK(static_cast<double>(up) >= value);
        if (value > 1e-37) {
            CHECK(static_cast<double>(down) >= value * (1 - 0x1p-20));
            CHECK(static_cast<double>(up) <= value * (1 + 0x1p-20));
            // Room for three roundings to float, in any direction, of what a stepper multiplies by.
            CHECK(static_cast<double>(down) <= value * (1 - 3 * 0x1p-23));
            CHECK(static_cast<double>(up) >= value * (1 + 3 * 0x1p-23));
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

}  // namespace taut_test::step_limit_test
