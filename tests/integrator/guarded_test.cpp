// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/guarded.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/lattice/chain.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/leaking.hpp"
#include "../support/laws.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::guarded_test {

using taut::Alarm;
using taut::Guarded;
using taut::Status;

namespace {

template <class Scalar>
using Cloth = taut::SpringSystem<Scalar, 3>;
using Springs = taut::SpringSystem<double, 2>;
using Symplectic = Guarded<taut::SymplecticEuler<Springs>>;

constexpr double frame = 1.0 / 60;  // s

template <class Scalar>
Cloth<Scalar> small_cloth() {
    taut::ClothOptions options;
    options.rows = options.columns = 8;
    return taut::hanging_cloth<Scalar>(options);
}

/// A spring from particle 5 to where it was built, which the analysis does not see.
void hide_spring(Springs& system, double stiffness) {
    const Eigen::Vector2d anchor = system.initial_state().x.col(5);
    system.set_external_force([stiffness, anchor](const auto& state, auto& f) {
        f.col(5) -= stiffness * (state.x.col(5) - anchor);
    });
}

}  // namespace

TEMPLATE_TEST_CASE("guarded: a frame in which nothing goes wrong is the stepper's own, to the bit",
                   "[integrator]", float, double) {
    const auto cloth = small_cloth<TestType>();
    auto state = cloth.initial_state();
    auto plain = state;
    Guarded<taut::SymplecticEuler<Cloth<TestType>>> guard(cloth);
    taut::SymplecticEuler stepper(cloth, taut::ExplicitOptions{1, taut::recipe.damping});
    for (int i = 0; i < 60; ++i) {
        const auto report = guard.advance(state, static_cast<TestType>(frame));
        REQUIRE(report);
        CHECK(report.alarm == Alarm::none);
        CHECK(report.retries == 0);
        CHECK(report.advanced == static_cast<TestType>(frame));
        CHECK(report.h <= taut::any_pose_limit(cloth).certified);
        REQUIRE(stepper.step(plain, report.h, report.substeps));
        REQUIRE(same_bits(state, plain));
    }
}

TEMPLATE_TEST_CASE("guarded: no false alarm on a falling cloth, at the largest certified step",
                   "[integrator]", (taut::SymplecticEuler<Cloth<float>>),
                   (taut::VelocityVerlet<Cloth<double>>), (taut::Bdf2<Cloth<double>>)) {
    using Scalar = typename TestType::Scalar;
    for (const bool damped : {false, true}) {
        auto cloth = small_cloth<Scalar>();
        if (damped) cloth.set_rayleigh({0.5, 1e-4});
        typename Guarded<TestType>::Options options;
        options.safety = 1;
        Guarded<TestType> guard(cloth, options);
        auto state = cloth.initial_state();
        int alarms = 0;
        for (int i = 0; i < 120; ++i) {
            const auto report = guard.advance(state, static_cast<Scalar>(frame));
            REQUIRE(report);
            alarms += report.retries;
        }
        CHECK(alarms == 0);
    }
}

TEST_CASE("guarded: crumpled random scenes of every law pass", "[integrator]") {
    using System = taut::SpringSystem<double, 2, TensionOnly, Buckling>;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        RandomOptions options;
        options.dampers = seed % 2 == 0;
        const auto system = random_like<System>(random, options);
        auto state = random_state(random, system);
        for (Index i = 0; i < 2; ++i) state.v.col(i).setZero();  // the pinned ones
        Guarded<taut::SymplecticEuler<System>> guard(system);
        for (int i = 0; i < 30; ++i) CHECK(guard.advance(state, frame));
    }
}

TEST_CASE("guarded: a stale limit is renewed", "[integrator]") {
    Random random(2);
    auto system = random_system<double, 2>(random);
    auto state = random_state(random, system);
    Symplectic guard(system);
    CHECK_FALSE(guard.limit());
    const auto before = guard.advance(state, frame);
    REQUIRE(before);
    system.add_spring(4, 6, 1e6);
    const auto after = guard.advance(state, frame);
    REQUIRE(after);
    CHECK(after.substeps > 4 * before.substeps);
    CHECK(guard.limit()->revision == system.revision());
    CHECK(after.h <= taut::any_pose_limit(system).certified);
}

TEST_CASE("guarded: a late frame is cut to max_substeps", "[integrator]") {
    const auto cloth = small_cloth<double>();
    auto state = cloth.initial_state();
    using Guard = Guarded<taut::SymplecticEuler<Cloth<double>>>;
    Guard::Options options;
    options.max_substeps = 7;
    Guard guard(cloth, options);
    const auto report = guard.advance(state, 10);
    REQUIRE(report);
    CHECK(report.substeps == 7);
    CHECK_THAT(report.advanced, WithinRel(7 * options.safety * guard.limit()->certified,
                                          Tolerance<double>::rounding));
    CHECK_THAT(state.time, WithinRel(report.advanced, Tolerance<double>::rounding));
}

TEST_CASE("guarded: a stiff force unseen by the analysis is stepped finer until it holds",
          "[integrator]") {
    auto system = taut::chain<double, 2>({8, taut::ChainEnds::fixed_fixed, 1, 100});
    auto state = system.initial_state();
    const double h = Symplectic(system).advance(state, 1).h;
    // Beyond 2/√(k/m): the energy grows within the frame, and stays finite.
    hide_spring(system, 6.5 / (h * h));
    state.x(0, 5) += 1e-3;
    Symplectic guard(system);
    const double start = state.time;
    const auto report = guard.advance(state, 1);
    CHECK(report);
    CHECK(report.alarm == Alarm::stiff_force);
    CHECK(report.retries >= 1);
    CHECK(report.h < h);
    CHECK_THAT(state.time, WithinRel(start + report.advanced, Tolerance<double>::rounding));
    CHECK((state.x - system.initial_state().x).cwiseAbs().maxCoeff() < 2e-3);
}

TEST_CASE("guarded: what no retry mends is taken back to the bit, and named", "[integrator]") {
    Random random(5);
    RandomOptions options;
    options.gravity = false;
    for (const double stiffness : {1e7, 1e12}) {
        auto system = random_system<double, 2>(random, options);
        hide_spring(system, stiffness);
        auto state = random_state(random, system);
        state.v.setZero();
        state.time = 1.5;
        const auto before = state;
        Symplectic::Options few;
        few.max_retries = 3;
        Symplectic guard(system, few);
        const auto report = guard.advance(state, 0.2);
        CHECK_FALSE(report);
        CHECK(report.status == Status::diverged);
        CHECK(report.retries == 3);
        CHECK(report.advanced == 0);
        CHECK(same_bits(state, before));
        CHECK(report.where == 5);
        REQUIRE(report.spring >= 0);
        const auto& springs = system.springs();
        CHECK((springs.a[report.spring] == 5 || springs.b[report.spring] == 5));
        // The guard is none the worse for it.
        system.set_external_force({});
        CHECK(guard.advance(state, frame));
        CHECK(state.time > before.time);
    }
}

TEMPLATE_TEST_CASE("guarded: a scene at rest stays there, also where nothing sets a scale",
                   "[integrator]", float, double) {
    for (const TestType height : {TestType(0), TestType(10.3)}) {
        auto cloth = small_cloth<TestType>();
        cloth.set_gravity(Cloth<TestType>::Vector::Zero());
        auto state = cloth.initial_state();
        state.x.array() += height;
        Guarded<taut::SymplecticEuler<Cloth<TestType>>> guard(cloth);
        for (int i = 0; i < 10; ++i) {
            const auto report = guard.advance(state, static_cast<TestType>(frame));
            REQUIRE(report);
            CHECK(report.retries == 0);
        }
    }
}

TEST_CASE("guarded: an implicit step that overshoots is noticed and stepped finer",
          "[integrator]") {
    // Slack strings that become taut within a step are not felt by its one linearised solve.
    taut::SpringSystem<double, 2, TensionOnly> chain;
    for (int i = 0; i < 9; ++i) {
        chain.add_particle({0.08 * i, -0.01 * (i % 2)}, 0.01);
        if (i > 0) {
            chain.add_spring(taut::Spring<double, TensionOnly>{i - 1, i, {1e4}, 0.1});
        }
    }
    chain.pin(0);
    chain.set_gravity({0, -9.81});
    auto bare = chain.initial_state();
    auto state = bare;
    taut::Bdf2 stepper(chain);
    Guarded<taut::Bdf2<decltype(chain)>> guard(chain);
    double rise_of_bare = 0;
    double rise = 0;
    int retries = 0;
    for (int i = 0; i < 120; ++i) {
        const double of_bare = chain.energy(bare);
        const double of_guarded = chain.energy(state);
        REQUIRE(stepper.step(bare, frame));
        const auto report = guard.advance(state, frame);
        REQUIRE(report);
        retries += report.retries;
        rise_of_bare = std::max(rise_of_bare, chain.energy(bare) - of_bare);
        rise = std::max(rise, chain.energy(state) - of_guarded);
    }
    CHECK(rise_of_bare > 0.1);  // J; the whole chain hangs within 0.3 J
    CHECK(retries > 0);
    CHECK(rise < 0.002 * rise_of_bare);
}

TEST_CASE("guarded: a rise that the slack admits once is not admitted for ever", "[integrator]") {
    auto system = taut::chain<double, 2>({8, taut::ChainEnds::free_free, 1, 100});
    auto state = system.initial_state();
    state.v.row(0).setOnes();
    using Guard = Guarded<Leaking<Springs>>;
    Guard::Options options;
    // 0.4 % of the kinetic energy a frame of 1/60 s, against a slack of 1 %.
    Leak leak{0.12};
    Leak slow_leak{0.4 * options.energy_drift};
    Guard tolerant(system, options, slow_leak);
    Guard strict(system, options, leak);
    auto slow = state;
    for (int i = 0; i < 300; ++i) REQUIRE(tolerant.advance(slow, frame));
    int frames = 0;
    while (frames < 300 && strict.advance(state, frame)) ++frames;
    CHECK(frames >= 2);
    CHECK(frames < 10);
}

TEST_CASE("guarded: a bad frame or state is reported and nothing is touched",
          "[integrator][bad_input]") {
    Random random(8);
    const auto system = random_system<double, 2>(random);
    auto state = random_state(random, system);
    const auto before = state;
    Symplectic guard(system);
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, infinity, std::nan("")}) {
        CHECK(guard.advance(state, bad).status == Status::invalid_step);
        CHECK(same_bits(state, before));
    }
    state.v(1, 3) = std::nan("");
    const auto report = guard.advance(state, frame);
    CHECK(report.status == Status::invalid_state);
    CHECK(report.where == 3);
    state.v = before.v.leftCols(2);
    CHECK(guard.advance(state, frame).status == Status::invalid_state);
}

TEST_CASE("guarded: options out of range are refused by name", "[integrator][bad_input]") {
    Random random(9);
    const auto system = random_system<double, 2>(random);
    const auto message = [&](auto change) {
        Symplectic::Options options;
        change(options);
        return message_of([&] { Symplectic(system, options); });
    };
    CHECK(missing(message([](auto& o) { o.safety = 1.5; }), {"Guarded", "safety is 1.5"}) == "");
    CHECK(missing(message([](auto& o) { o.safety = 0; }), {"Guarded", "safety is 0"}) == "");
    CHECK(missing(message([](auto& o) { o.max_step = 0; }), {"Guarded", "max_step is 0"}) == "");
    CHECK(missing(message([](auto& o) { o.max_substeps = 0; }), {"max_substeps is 0"}) == "");
    CHECK(missing(message([](auto& o) { o.max_retries = -1; }), {"max_retries is -1"}) == "");
    CHECK(missing(message([](auto& o) { o.max_retries = 31; }), {"max_retries is 31"}) == "");
    const auto many = [](auto& o) { o.max_substeps = std::numeric_limits<Index>::max() / 32; };
    CHECK(missing(message(many), {"max_substeps is ", "6 retries"}) == "");
    CHECK(missing(message([](auto& o) { o.energy_slack = -1; }), {"energy_slack is -1"}) == "");
    CHECK(missing(message([](auto& o) { o.energy_drift = -1; }), {"energy_drift is -1"}) == "");
    CHECK(message([](auto&) {}) == "");
}

}  // namespace taut_test::guarded_test
