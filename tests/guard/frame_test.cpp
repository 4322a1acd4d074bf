// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What every frame of Guard is, whatever its energy does.
#include <cmath>
#include <limits>
#include <taut/guard/guard.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::guard_frame_test {

using taut::Guard;
using taut::Status;

namespace {

using Cloth = taut::SpringSystem<double, 3>;

constexpr double frame = 1.0 / 60;  // s

Cloth small_cloth(Index size = 8) {
    taut::ClothOptions options;
    options.rows = options.columns = size;
    return taut::hanging_cloth<double>(options);
}

}  // namespace

TEST_CASE("guard: needs no options, and leaves a calm trial as it is, to the bit", "[guard]") {
    const auto cloth = small_cloth();
    Guard guard(cloth);
    static_assert(std::is_same_v<decltype(guard), Guard<taut::VelocityVerlet<Cloth>>>);
    taut::GuardOptions<double> options;
    options.threads = 3;
    Guard threaded(cloth, options);
    static_assert(std::is_same_v<decltype(threaded), decltype(guard)>);
    taut::VelocityVerlet bare(cloth);
    auto state = cloth.initial_state();
    auto plain = state, other = state;
    int untouched = 0;
    for (int i = 0; i < 60; ++i) {
        const auto report = guard.advance(state, frame);
        REQUIRE(report);
        CHECK(report.advanced == frame);
        CHECK(report.parts == 1);
        CHECK(report.h <= 0.95 * taut::any_pose_limit(cloth).certified);
        REQUIRE(threaded.advance(other, frame));
        CHECK(same_bits(state, other));
        REQUIRE(bare.step(plain, report.h, report.substeps));
        if (report.taken == taut::Taken::tried) {
            ++untouched;
            CHECK(same_bits(state, plain));
        }
        plain = state;
    }
    CHECK(untouched > 50);
}

TEST_CASE("guard: limits and parts follow the system", "[guard]") {
    auto cloth = small_cloth();
    Guard guard(cloth);
    CHECK_FALSE(guard.limit());
    auto state = cloth.initial_state();
    const auto before = guard.advance(state, frame);
    REQUIRE(before);
    cloth.add_spring(20, 37, 1e5);
    cloth.remove_springs(
        [&](Index s) { return (cloth.springs().a[s] < 40) != (cloth.springs().b[s] < 40); });
    const auto after = guard.advance(state, frame);
    REQUIRE(after);
    CHECK(after.substeps > 2 * before.substeps);
    CHECK(after.parts == 2);
    CHECK(guard.limit()->revision == cloth.revision());
}

TEST_CASE("guard: a late frame is cut to max_substeps", "[guard]") {
    const auto cloth = small_cloth();
    auto state = cloth.initial_state();
    taut::GuardOptions<double> options;
    options.max_substeps = 7;
    Guard guard(cloth, options);
    const auto report = guard.advance(state, 10);
    REQUIRE(report);
    CHECK(report.substeps == 7);
    CHECK_THAT(report.advanced,
               WithinRel(7 * 0.95 * guard.limit()->certified, Tolerance<double>::rounding));
    CHECK_THAT(state.time, WithinRel(report.advanced, Tolerance<double>::rounding));
}

TEST_CASE("guard: frames of any length", "[guard]") {
    const auto cloth = small_cloth(5);
    for (const double span : {1e-300, 1e-12, 1e-3, 0.1, 10.0}) {
        auto state = cloth.initial_state();
        Guard guard(cloth);
        for (int i = 0; i < 5; ++i) REQUIRE(guard.advance(state, span));
        CHECK(state.finite());
    }
}

TEST_CASE("guard: a bad frame or state is reported and nothing is touched", "[guard][bad_input]") {
    const auto cloth = small_cloth(5);
    auto state = cloth.initial_state();
    const auto before = state;
    Guard guard(cloth);
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, infinity, std::nan("")}) {
        CHECK(guard.advance(state, bad).status == Status::invalid_step);
        CHECK(same_bits(state, before));
    }
    state.v(1, 0) = infinity;  // of a pin
    CHECK(guard.advance(state, frame).status == Status::invalid_state);
    state = before;
    state.v(1, 3) = std::nan("");
    const auto report = guard.advance(state, frame);
    CHECK(report.status == Status::invalid_state);
    CHECK(report.where == 3);
    CHECK(report.advanced == 0);
    state.v = before.v.leftCols(2);
    CHECK(guard.advance(state, frame).status == Status::invalid_state);
    state = before;
    state.v(0, 7) = 1e200;  // its energy overflows
    CHECK(guard.advance(state, frame).status == Status::invalid_state);
    state = before;
    CHECK(guard.advance(state, frame));
}

TEST_CASE("guard: options out of range are refused by name", "[guard][bad_input]") {
    const auto cloth = small_cloth(3);
    const auto message = [&](auto change) {
        taut::GuardOptions<double> options;
        change(options);
        return message_of([&] { Guard guard(cloth, options); });
    };
    CHECK(missing(message([](auto& o) { o.share = 1.5; }), {"Guard", "share is 1.5"}) == "");
    CHECK(missing(message([](auto& o) { o.share = 0; }), {"Guard", "share is 0"}) == "");
    CHECK(missing(message([](auto& o) { o.max_step = 0; }), {"max_step is 0"}) == "");
    CHECK(missing(message([](auto& o) { o.max_substeps = 0; }), {"max_substeps is 0"}) == "");
    CHECK(missing(message([](auto& o) { o.threads = 0; }), {"threads is 0"}) == "");
    CHECK(message([](auto&) {}) == "");
}

TEST_CASE("guard: scenes without springs, without free particles, with drag alone", "[guard]") {
    Cloth system;
    Guard guard(system);
    auto none = system.initial_state();
    CHECK(guard.advance(none, frame));
    for (int i = 0; i < 4; ++i) system.add_particle({0.1 * i, 0, 0}, 1 + i);
    system.set_gravity({0, 0, -10});
    auto state = system.initial_state();
    auto report = guard.advance(state, frame);
    REQUIRE(report);
    CHECK(report.parts == 4);
    CHECK_THAT(state.v(2, 1), WithinRel(-10 * frame, 1e-12));
    CHECK(report.again == 0);
    system.set_rayleigh({30, 0});
    state.v.row(0).setConstant(5);
    for (int i = 0; i < 60; ++i) {
        report = guard.advance(state, frame);
        REQUIRE(report);
        CHECK(report.again == 0);
    }
    CHECK(std::abs(state.v(0, 1)) < 0.01);
    CHECK_THAT(state.v(2, 1), WithinRel(-10.0 / 30, 0.05));
    for (int i = 0; i < 4; ++i) system.pin(i);
    state.v.setOnes();
    const double x = state.x(0, 0);
    CHECK(guard.advance(state, frame));
    CHECK_THAT(state.x(0, 0), WithinRel(x + frame, 1e-12));
}

TEMPLATE_TEST_CASE("guard: a scene at rest stays there, near the origin and far away", "[guard]",
                   float, double) {
    taut::ClothOptions options;
    options.rows = options.columns = 8;
    for (const TestType away : {TestType(0), TestType(10.3), TestType(100)}) {
        auto cloth = taut::hanging_cloth<TestType>(options);
        cloth.set_gravity(cloth.gravity() * 0);
        auto state = cloth.initial_state();
        state.x.array() += away;
        Guard guard(cloth);
        Index again = 0;
        for (int i = 0; i < 60; ++i) {
            const auto report = guard.advance(state, TestType(1) / 60);
            REQUIRE(report);
            again += report.again;
        }
        CHECK(again == 0);
        CHECK(largest(state.v) < 1e-2);
    }
}

TEST_CASE("guard: a function of the user's takes frames", "[guard]") {
    const auto cloth = small_cloth();
    taut::VelocityVerlet stepper(cloth);
    int calls = 0;
    auto trial = [&](Cloth::State& state, double span) {
        ++calls;
        return bool(stepper.step(state, span / 64, 64));
    };
    const auto refusing = [](Cloth::State&, double) { return false; };
    const auto idle = [](Cloth::State&, double) {};
    Guard guard(cloth, trial);
    Guard always_again(cloth, refusing);
    Guard resting(cloth, idle);
    auto state = cloth.initial_state();
    auto other = state;
    Index again = 0;
    for (int i = 0; i < 30; ++i) {
        const auto report = guard.advance(state, frame);
        REQUIRE(report);
        again += report.again;
        CHECK_THAT(state.time, WithinRel((i + 1) * frame, 1e-9));
        const auto repeated = always_again.advance(other, frame);
        REQUIRE(repeated);
        CHECK(repeated.again == 1);
    }
    CHECK(calls == 30);
    CHECK(again == 0);
    CHECK(distance(state.x, other.x) < 0.1);
    CHECK(distance(state.x, other.x) > 0);
    REQUIRE(resting.advance(other, frame));
}

TEST_CASE("guard: after three frames taken again the trial pauses", "[guard]") {
    const auto cloth = small_cloth(4);
    int calls = 0;
    auto trial = [&](Cloth::State&, double) {
        ++calls;
        return false;
    };
    Guard guard(cloth, trial);
    auto state = cloth.initial_state();
    for (int i = 0; i < 3 + 2 + 1 + 4 + 1 + 8 + 1; ++i) REQUIRE(guard.advance(state, frame));
    CHECK(calls == 6);
}

TEST_CASE("guard: an engine's arrays get what a State gets, to the bit", "[guard]") {
    const auto cloth = small_cloth();
    auto state = cloth.initial_state();
    std::vector<double> x(4 * static_cast<std::size_t>(cloth.size())), v(x.size());
    taut::StateView<double, 3> view(x.data(), v.data(), cloth.size(), 4);
    view.copy_from(state);
    Guard on_state(cloth), on_view(cloth);
    for (int i = 0; i < 60; ++i) {
        REQUIRE(on_state.advance(state, frame));
        REQUIRE(on_view.advance(view, frame));
        CHECK(view.x == state.x);
        CHECK(view.v == state.v);
        CHECK(view.time == state.time);
        if (i == 30) {
            state.v.col(20).setOnes();
            view.v.col(20).setOnes();
        }
    }
}

TEST_CASE("guard: a force that is not finite is named, and the state is as before",
          "[guard][bad_input]") {
    auto cloth = small_cloth();
    cloth.set_external_force([](const auto& s, auto& f) {
        if (s.time > 0.06) f.col(5).setConstant(std::numeric_limits<double>::quiet_NaN());
    });
    Guard guard(cloth);
    auto state = cloth.initial_state();
    int refused = 0;
    for (int i = 0; i < 10; ++i) {
        const auto before = state;
        const auto report = guard.advance(state, frame);
        if (report) continue;
        ++refused;
        CHECK(report.status == Status::diverged);
        CHECK(report.where == 5);
        CHECK(report.advanced == 0);
        REQUIRE(report.force != nullptr);
        CHECK(std::string(report.force) == "set_external_force");
        CHECK(same_bits(state, before));
    }
    CHECK(refused >= 6);
    cloth.set_external_force({});
    CHECK(guard.advance(state, frame));
}

}  // namespace taut_test::guard_frame_test
