// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <taut/guard/guard.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/wind/wind.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

// What the guard books of moving pins and of forces given as code, and what it does about them.

namespace taut_test::guarded_work_test {

namespace {

constexpr double frame = 1.0 / 60;  // s

/// A stepper that shows the guard nothing: its frames are taken a step at a time.
template <class System>
struct Unseen {
    using State = typename System::State;
    using Scalar = typename System::Scalar;
    static constexpr taut::Method method = taut::Method::velocity_verlet;
    taut::VelocityVerlet<System> verlet;

    explicit Unseen(const System& system) : verlet(system) {}
    taut::Report step(State& state, Scalar h, Index count) { return verlet.step(state, h, count); }
};

/// A net on a line, in no order, or a cloth, some of it pinned.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> scene(Random& random, int kind) {
    if constexpr (Dim == 3) {
        if (kind == 0) return taut::hanging_cloth<Scalar>({20, 17});
    }
    RandomOptions options;
    options.particles = kind == 1 ? 30 : 700;
    auto system = random_system<Scalar, Dim>(random, options);
    for (int i = 0; i < 4; ++i) system.pin(random.below(system.size()));
    return system;
}

}  // namespace

TEMPLATE_TEST_CASE("Guarded books the same work between the steps of a sweep as step by step",
                   "[guard]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    using System = taut::SpringSystem<Scalar, TestType::Dim>;
    Random random(4400 + TestType::Dim);
    for (int repeat = 0; repeat < 12; ++repeat) {
        System system = scene<Scalar, TestType::Dim>(random, repeat % 3);
        if (repeat % 2 == 1) {
            system.set_external_force([](const auto& state, auto& f) {
                f.row(0).array() += Scalar(std::cos(3 * double(state.time)));
                f -= Scalar(0.5) * state.x;
            });
        }
        if (repeat % 4 >= 2)
            system.set_constant_force(3, random.vector<Scalar, TestType::Dim>(-1, 1));
        auto state = system.initial_state();
        state.time = Scalar(1);
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) state.v.col(i).setConstant(Scalar(0.1));
        }
        auto other = state;
        taut::Guarded seen(system);
        Unseen<System> stepper(system);
        taut::Guarded unseen(system, stepper);
        for (int i = 0; i < 4; ++i) {
            const auto a = seen.advance(state, Scalar(frame));
            const auto b = unseen.advance(other, Scalar(frame));
            INFO("scene " << repeat << ", frame " << i << ", " << a.substeps << " steps");
            REQUIRE(a);
            REQUIRE(b);
            const double size = std::abs(a.work) + std::abs(a.energy) + a.slack;
            CHECK(std::abs(a.work - b.work) <=
                  (std::is_same_v<Scalar, double> ? 1e-9 : 2e-4) * size);
            CHECK((std::is_same_v<Scalar, float> || a.taken == b.taken));
        }
    }
}

TEST_CASE("Guarded books forces of time at their time", "[guard]") {
    for (const bool again : {false, true}) {
        taut::SpringSystem<double, 3> net;
        net.add_particle({0, 0, 0}, 1);
        net.set_external_force(
            [](const auto& s, auto& f) { f(0, 0) += 10 * std::cos(3 * double(s.time)); });
        auto state = net.initial_state();
        state.time = 1;
        double work = 0;
        int frozen = 0;
        const auto advance = [&](auto& guard) {
            for (int i = 0; i < 120; ++i) {
                const auto report = guard.advance(state, frame);
                work += report.work;
                frozen += report.frozen > 0;
            }
        };
        const auto spoil = [](auto& s, double) { s.v.setConstant(NAN); };
        taut::Guarded plain(net);
        taut::Guarded spoilt(net, spoil);
        again ? advance(spoilt) : advance(plain);
        const double exact = 10 * (std::sin(9.0) - std::sin(3.0)) / 3;
        CHECK(frozen == 0);
        CHECK_THAT(state.v(0, 0), WithinRel(exact, again ? 0.2 : 1e-3));
        CHECK_THAT(work, WithinRel(net.kinetic_energy(state), again ? 0.2 : 0.05));
    }
}

TEST_CASE("Mild forces given as code neither stop a part nor take its motion", "[guard]") {
    for (const double omega : {1.0, 3.0, 10.0, 20.0}) {
        for (const bool pair : {false, true}) {
            INFO("omega " << omega << ", a pair: " << pair);
            taut::SpringSystem<double, 3> net;
            net.add_particle({0.1, 0, 0}, 1);
            if (pair) {
                net.add_particle({0.1, 0.1, 0}, 1);
                net.add_spring(0, 1, 10);
            }
            net.set_external_force([=](const auto& s, auto& f) { f -= omega * omega * s.x; });
            auto state = net.initial_state();
            taut::Guarded guard(net);
            double late = 0;
            int again = 0;
            for (int i = 0; i < 1200; ++i) {
                const auto report = guard.advance(state, frame);
                REQUIRE(report);
                again += report.again > 0;
                if (i >= 600) late = std::max(late, std::abs(state.x(0, 0)));
            }
            CHECK(again <= 2);
            CHECK_THAT(late, WithinRel(0.1, 0.02));
        }
    }
    for (const double drag : {1.0, 10.0, 25.0}) {
        INFO("drag " << drag);
        taut::SpringSystem<double, 3> net;
        net.add_particle({0, 0, 0}, 1);
        net.set_gravity({0, 0, -10});
        net.set_external_force([=](const auto& s, auto& f) { f -= drag * s.v; });
        auto state = net.initial_state();
        taut::Guarded guard(net);
        for (int i = 0; i < 300; ++i) REQUIRE(guard.advance(state, frame));
        CHECK_THAT(-state.v(2, 0), WithinRel(10 / drag * (1 - std::exp(-5 * drag)), 0.01));
    }
}

TEST_CASE("A force too stiff for one step a frame is followed in shorter ones", "[guard]") {
    for (const double omega : {100.0, 125.0, 300.0}) {  // one step of 1/60 s grows from 120 on
        INFO("omega " << omega);
        taut::SpringSystem<double, 3> net;
        net.add_particle({0.1, 0, 0}, 1);
        net.set_external_force([=](const auto& s, auto& f) { f -= omega * omega * s.x; });
        auto state = net.initial_state();
        taut::Guarded guard(net);
        const double first = 0.5 * omega * omega * 0.01;
        int frozen = 0;
        for (int i = 0; i < 600; ++i) {
            frozen += guard.advance(state, frame).frozen > 0;
            const double energy = double(net.kinetic_energy(state)) +
                                  0.5 * omega * omega * double(state.x.squaredNorm());
            REQUIRE(energy <= 4 * first);
        }
        CHECK(frozen == 0);
    }
}

TEST_CASE("A refused frame leaves nothing behind", "[guard]") {
    using Net = taut::SpringSystem<double, 3>;
    Net net;
    net.add_particle({0, 0, 0}, 1);
    net.add_particle({1, 0, 0}, 1);
    net.add_spring(0, 1, 100);
    double kick = 0;
    const auto trial = [&](Net::State& s, double h) {
        s.v(0, 1) += kick;
        s.x += h * s.v;
    };
    enum class Bad { none, not_finite, throws, resizes };
    Bad bad = Bad::none;
    int calls = 0;
    const auto respond = [&](Net::State& s) {
        if (bad == Bad::none || ++calls < 2) return;
        if (bad == Bad::not_finite) s.v(0, 0) = NAN;
        if (bad == Bad::throws) throw std::runtime_error("respond");
        if (bad == Bad::resizes) s.x.conservativeResize(3, 1);
    };
    for (const Bad kind : {Bad::not_finite, Bad::throws, Bad::resizes}) {
        taut::Guarded guard(net, trial);
        auto state = net.initial_state();
        REQUIRE(guard.advance(state, frame, respond));
        const auto before = state;
        kick = 100;
        bad = kind;
        calls = 0;
        if (kind == Bad::throws) {
            CHECK_THROWS_AS((void)guard.advance(state, frame, respond), std::runtime_error);
        } else {
            const auto refused = guard.advance(state, frame, respond);
            CHECK_FALSE(refused);
            CHECK(refused.force == std::string("respond"));
        }
        CHECK(state.x == before.x);
        CHECK(state.v == before.v);
        CHECK(state.time == before.time);
        bad = Bad::none;
        const auto next = guard.advance(state, frame, respond);
        CHECK(next.taken == taut::Taken::again);
        CHECK(next.energy <= 1e-9);
        kick = 0;
    }
}

TEST_CASE("A late frame has no more steps than it may", "[guard]") {
    Random random(4410);
    for (int repeat = 0; repeat < 60; ++repeat) {
        taut::SpringSystem<float, 2> net;
        net.add_particle({0, 0}, static_cast<float>(random.uniform(0.1, 10)));
        net.add_particle({1, 0}, static_cast<float>(random.uniform(0.1, 10)));
        net.add_spring(0, 1, static_cast<float>(random.uniform(1, 1e4)));
        auto state = net.initial_state();
        taut::GuardedOptions<float> options;
        options.max_substeps = 1 + random.below(20);
        taut::Guarded guard(net, options);
        CHECK(guard.advance(state, 100.0f).substeps <= options.max_substeps);
    }
}

TEST_CASE("In float a cloth that is carried along at rest is not taken again for ever",
          "[guard][slow]") {
    taut::ClothOptions options;
    options.rows = options.columns = 10;
    const auto cloth = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<float>(options));
    auto held = cloth;
    for (Index i = 0; i < 10; ++i) held.pin(i);
    auto state = held.initial_state();
    state.v.row(0).setConstant(1.0f);
    taut::Guarded guard(held);
    int again = 0;
    for (int i = 0; i < 600; ++i) {
        const auto report = guard.advance(state, static_cast<float>(frame));
        REQUIRE(report);
        again += report.again > 0;
    }
    CHECK(again <= 12);
}

TEST_CASE("Guarded books what lifting a cloth takes, however fast, and lets it rest in the lift",
          "[guard]") {
    using Cloth = taut::SpringSystem<double, 3, taut::TensionOnly>;
    taut::ClothOptions options;
    options.rows = options.columns = 8;
    auto cloth = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<double>(options));
    auto rest = cloth.initial_state();
    {
        auto damped = cloth;
        damped.set_rayleigh({20, 0});
        const double h = taut::energy_limit(damped).certified;
        taut::EnergyStableEuler<Cloth> stepper(damped);
        REQUIRE(stepper.step(rest, h, static_cast<Index>(20 / h)));
    }
    double mass = 0;
    for (Index i = 0; i < cloth.size(); ++i) mass += cloth.is_pinned(i) ? 0 : cloth.mass(i);
    for (const double u : {-3.0, -1.0, 0.3, 1.0, 3.0, 10.0}) {
        INFO("lifted at " << u << " m/s");
        auto state = rest;
        state.v.setZero();
        state.v.row(2).setConstant(u);
        taut::Guarded guard(cloth);
        double work = 0;
        int again = 0;
        for (int i = 0; i < 120; ++i) {
            const auto report = guard.advance(state, frame);
            REQUIRE(report);
            work += report.work;
            again += report.again > 0;
        }
        CHECK(again == 0);
        CHECK_THAT(work, WithinRel(mass * 9.81 * u * 2, 0.01));
    }
}

TEST_CASE("A pendulum keeps its swing under Guarded", "[guard]") {
    for (const double k : {100.0, 1e4, 1e5}) {
        INFO(k << " N/m");
        taut::SpringSystem<double, 3> net;
        net.add_particle({0, 0, 0}, 1);
        net.add_particle({1, 0, 0}, 1);
        net.add_spring(0, 1, k);
        net.pin(0);
        net.set_gravity({0, 0, -9.81});
        auto state = net.initial_state();
        taut::Guarded guard(net);
        double late = 0;
        for (int i = 0; i < 1800; ++i) {
            REQUIRE(guard.advance(state, frame));
            if (i >= 1500) late = std::max(late, double(net.kinetic_energy(state)));
        }
        CHECK(late >= 9.2);
        CHECK(late <= 10);
    }
}

TEST_CASE("A response beside a stiff force given as code does not let it explode", "[guard]") {
    for (const double stiffness : {1e3, 1e5, 1e6}) {
        for (const bool touches : {false, true}) {
            INFO("a floor of " << stiffness << " N/m, responses " << touches);
            taut::ClothOptions options;
            options.rows = options.columns = 6;
            auto cloth = taut::hanging_cloth<double>(options);
            for (Index i = 0; i < cloth.size(); ++i) {
                if (cloth.is_pinned(i)) cloth.unpin(i);
            }
            cloth.set_external_force([=](const auto& s, auto& f) {
                f.row(2) -= stiffness * (s.x.row(2).array() + 0.3).min(0.0).matrix();
            });
            auto state = cloth.initial_state();
            taut::Guarded guard(cloth);
            const auto respond = [&](auto& s) {
                if (touches) s.v(0, 0) += 1e-13;
            };
            for (int i = 0; i < 120; ++i) {
                (void)guard.advance(state, frame, respond);
                REQUIRE(state.v.colwise().norm().maxCoeff() < 20);
                REQUIRE(state.x.row(2).maxCoeff() < 1);
            }
        }
    }
}

}  // namespace taut_test::guarded_work_test
