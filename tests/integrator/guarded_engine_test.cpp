// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// A guard beside its stepper, its system and an engine.
#include <cmath>
#include <limits>
#include <taut/integrator/guarded.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <type_traits>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::guarded_engine_test {

using taut::Status;

namespace {

template <class Scalar>
using Springs = taut::SpringSystem<Scalar, 2>;
template <class Scalar>
using Stepper = taut::SymplecticEuler<Springs<Scalar>>;

template <class Scalar_>
struct Guarding {
    using Scalar = Scalar_;
    using Guard = taut::Guarded<Stepper<Scalar>>;
};
constexpr double frame = 1.0 / 30;

/// A scene that moves, of its own for each seed.
template <class Scalar>
struct Scene {
    explicit Scene(std::uint32_t seed) : random(seed) {
        RandomOptions options;
        options.dampers = true;
        system = random_like<Springs<Scalar>>(random, options);
        state = random_state(random, system);
        state.v.leftCols(options.pinned).setZero();
    }
    /// From 0.06 s on the force on particle 5 is not a number.
    void spoil() {
        system.set_external_force([](const auto& s, auto& f) {
            if (s.time > Scalar(0.06)) {
                f.col(5).setConstant(std::numeric_limits<Scalar>::quiet_NaN());
            }
        });
    }

    Random random;
    Springs<Scalar> system;
    taut::State<Scalar, 2> state;
};

/// An engine's arrays of another precision, with room between the particles.
template <class Stored>
struct Engine {
    template <class State>
    explicit Engine(const State& state)
        : x(4 * state.x.cols()),
          v(3 * state.v.cols()),
          view(x.data(), 4, v.data(), 3, state.x.cols()) {
        view.copy_from(state);
    }

    std::vector<Stored> x;
    std::vector<Stored> v;
    taut::StateView<Stored, 2> view;
};

}  // namespace

TEMPLATE_TEST_CASE("guarded: its own stepper and a lent one give the same bits", "[integrator]",
                   Guarding<float>, Guarding<double>) {
    using Scalar = typename TestType::Scalar;
    using Guard = typename TestType::Guard;
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        INFO("seed " << seed);
        Scene<Scalar> scene(seed);
        auto others = scene.state;
        auto copied = scene.state;
        Guard own(scene.system);
        auto lent = std::as_const(own).stepper();
        Guard borrowing(scene.system, lent);
        CHECK(&borrowing.stepper() == &lent);
        CHECK(&Guard(borrowing).stepper() == &lent);
        Guard copy(own);
        CHECK(&copy.stepper() != &own.stepper());
        for (int i = 0; i < 5; ++i) {
            const auto report = own.advance(scene.state, Scalar(frame));
            REQUIRE(report);
            CHECK(report.where == -1);
            CHECK(report.advanced == Scalar(frame));
            CHECK(report.h > 0);
            REQUIRE(borrowing.advance(others, Scalar(frame)));
            REQUIRE(copy.advance(copied, Scalar(frame)));
            CHECK(same_bits(scene.state, others));
            CHECK(same_bits(scene.state, copied));
        }
    }
}

TEMPLATE_TEST_CASE("guarded: the stepper and the options are at hand, temporaries are refused",
                   "[integrator]", Guarding<double>) {
    using Guard = typename TestType::Guard;
    using Options = typename Guard::Options;
    using System = Springs<double>;
    using Kind = Stepper<double>;
    static_assert(std::is_constructible_v<Guard, const System&>);
    static_assert(std::is_constructible_v<Guard, const System&, Options>);
    static_assert(std::is_constructible_v<Guard, System&, Options, taut::ExplicitOptions>);
    static_assert(std::is_constructible_v<Guard, const System&, Kind&>);
    static_assert(std::is_constructible_v<Guard, System&, Kind&, Options>);
    static_assert(!std::is_constructible_v<Guard, System>);
    static_assert(!std::is_constructible_v<Guard, const System, Options>);
    static_assert(!std::is_constructible_v<Guard, System, Options, taut::ExplicitOptions>);
    static_assert(!std::is_constructible_v<Guard, System, Kind&>);
    static_assert(!std::is_constructible_v<Guard, System, Kind&, Options>);
    static_assert(!std::is_constructible_v<Guard, const System&, Kind>);
    static_assert(!std::is_constructible_v<Guard, const System&, Kind, Options>);
    static_assert(!std::is_convertible_v<const System&, Guard>);

    const Scene<double> scene(6);
    Options options;
    options.max_step = 1e-4;
    const Guard guard(scene.system, options, taut::ExplicitOptions{1, {0.25, 0}});
    CHECK(guard.options().max_step == 1e-4);
    CHECK(guard.stepper().damping().look_ahead == 0.25);
}

TEST_CASE("guarded: a lent stepper names the types", "[integrator]") {
    const Scene<double> scene(7);
    Stepper<double> stepper(scene.system);
    taut::Guarded guard(scene.system, stepper);
    CHECK(std::is_same_v<decltype(guard), Guarding<double>::Guard>);
}

TEMPLATE_TEST_CASE("guarded: an engine's arrays get what a State gets, rounded once",
                   "[integrator]", Guarding<float>, Guarding<double>) {
    using Scalar = typename TestType::Scalar;
    using Guard = typename TestType::Guard;
    for (std::uint32_t seed = 11; seed <= 15; ++seed) {
        INFO("seed " << seed);
        Scene<Scalar> scene(seed);
        // Else float arrays would start elsewhere than the State.
        scene.state.x = scene.state.x.template cast<float>().template cast<Scalar>();
        scene.state.v = scene.state.v.template cast<float>().template cast<Scalar>();
        Engine<float> floats(scene.state);
        Engine<double> doubles(scene.state);
        Guard of_state(scene.system);
        Guard of_floats(scene.system);
        Guard of_doubles(scene.system);
        for (int i = 0; i < 5; ++i) {
            REQUIRE(of_state.advance(scene.state, Scalar(frame)));
            REQUIRE(of_floats.advance(floats.view, Scalar(frame)));
            REQUIRE(of_doubles.advance(doubles.view, Scalar(frame)));
            CHECK(floats.view.x == scene.state.x.template cast<float>());
            CHECK(floats.view.v == scene.state.v.template cast<float>());
            CHECK(doubles.view.x == scene.state.x.template cast<double>());
            CHECK(doubles.view.v == scene.state.v.template cast<double>());
            CHECK(doubles.view.time == static_cast<double>(scene.state.time));
        }
        // Touched arrays are read again.
        scene.state.v.col(3).setOnes();
        doubles.view.v.col(3).setOnes();
        REQUIRE(of_state.advance(scene.state, Scalar(frame)));
        REQUIRE(of_doubles.advance(doubles.view, Scalar(frame)));
        CHECK(doubles.view.x == scene.state.x.template cast<double>());
    }
}

TEMPLATE_TEST_CASE("guarded: what cannot be advanced is refused and left as it is",
                   "[integrator][bad_input]", Guarding<float>, Guarding<double>) {
    using Scalar = typename TestType::Scalar;
    using Guard = typename TestType::Guard;
    Scene<Scalar> scene(21);
    Guard guard(scene.system);
    const auto refused = [&](auto state, Scalar duration, Status status, Index where) {
        const auto before = state;
        Engine<double> engine(state);
        const Engine<double> untouched(state);
        for (const auto& report :
             {guard.advance(state, duration), guard.advance(engine.view, duration)}) {
            CHECK(report.status == status);
            CHECK(report.where == where);
            CHECK(report.advanced == 0);
        }
        const auto same = [](const auto& a, const auto& b) {
            return ((a.array() == b.array()) || (a.array() != a.array())).all();
        };
        CHECK(state.time == before.time);
        CHECK(same(state.x, before.x));
        CHECK(same(state.v, before.v));
        CHECK(same(engine.view.x, untouched.view.x));
        CHECK(same(engine.view.v, untouched.view.v));
    };
    const Scalar infinity = std::numeric_limits<Scalar>::infinity();
    for (const Scalar bad : {Scalar(0), Scalar(-1), infinity, Scalar(std::nan(""))}) {
        refused(scene.state, bad, Status::invalid_step, -1);
    }
    for (const Scalar bad : {infinity, Scalar(std::nan(""))}) {
        auto state = scene.state;
        const Index i = scene.random.below(state.x.cols());
        (scene.random.below(2) == 0 ? state.x : state.v)(1, i) = bad;
        refused(state, Scalar(frame), Status::invalid_state, i);
    }
    auto fewer = scene.state;
    fewer.x.conservativeResize(2, 5);
    fewer.v.conservativeResize(2, 5);
    refused(fewer, Scalar(frame), Status::invalid_state, -1);
    CHECK(guard.advance(scene.state, Scalar(frame)));  // and nothing of it is left
}

TEMPLATE_TEST_CASE("guarded: a failure names the particle and leaves the last state that is good",
                   "[integrator][bad_input]", Guarding<float>, Guarding<double>) {
    using Scalar = typename TestType::Scalar;
    using Guard = typename TestType::Guard;
    for (std::uint32_t seed = 31; seed <= 35; ++seed) {
        INFO("seed " << seed);
        Scene<Scalar> scene(seed);
        scene.spoil();
        Engine<Scalar> engine(scene.state);
        Guard of_state(scene.system);
        Guard of_engine(scene.system);
        bool failed = false;
        for (int i = 0; i < 3; ++i) {
            const auto before = scene.state;
            const auto report = of_state.advance(scene.state, Scalar(frame));
            CHECK(bool(of_engine.advance(engine.view, Scalar(frame))) == bool(report));
            CHECK(engine.view.x == scene.state.x);
            CHECK(engine.view.v == scene.state.v);
            CHECK(scene.state.finite());
            CHECK_THAT(scene.state.time - before.time,
                       WithinAbs(report.advanced, Tolerance<Scalar>::accumulated));
            CHECK(report.where == (report ? -1 : 5));
            if (report) continue;
            failed = true;
            CHECK(report.status == Status::diverged);
            CHECK(report.advanced < Scalar(frame));
            if (report.advanced == 0) CHECK(same_bits(scene.state, before));
        }
        CHECK(failed);
    }
}

}  // namespace taut_test::guarded_engine_test
