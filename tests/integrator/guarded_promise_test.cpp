// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What `ok` promises, by trying to break it.
#include <cmath>
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/guarded.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/newton/newton.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/contact/contact.hpp>

#include "../support/catch.hpp"
#include "../support/promise.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::guarded_promise_test {

using taut::Alarm;
using taut::Guarded;

namespace {

/// A mass on a pinned spring, anywhere at any speed: pressed through the pin, the force turns by
/// half a circle within a step.
template <class System>
System swung_mass(Random& random, double damper, typename System::State& state) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    System system;
    system.add_particle(System::Vector::Zero(), 1);
    system.add_particle(System::Vector::Unit(0), static_cast<Scalar>(log_uniform(random, 0.1, 10)));
    using Law = typename System::FirstLaw;
    system.add_spring(
        taut::Spring<Scalar, Law>{0,
                                  1,
                                  {static_cast<Scalar>(log_uniform(random, 1e2, 1e5))},
                                  Scalar(1),
                                  static_cast<Scalar>(damper)});
    system.pin(0);
    state = system.initial_state();
    state.x.col(1) = random.vector<Scalar, Dim>(-2, 2);
    const double fast = std::sqrt(static_cast<double>(system.springs().parameters[0].stiffness) /
                                  static_cast<double>(system.mass(1)));
    state.v.col(1) = random.vector<Scalar, Dim>(-fast, fast);
    return system;
}

template <class Stepper, class System>
void check_swung_masses(double seconds) {
    using Scalar = typename System::Scalar;
    int finished = 0;
    for (std::uint32_t seed = 1; seed <= 30; ++seed) {
        for (const double damper : {0.0, 0.3}) {
            INFO("seed " << seed << ", damper " << damper);
            Random random(seed);
            typename System::State state;
            const System system = swung_mass<System>(random, damper, state);
            Guarded<Stepper> guard(system);
            const Scalar limit = taut::any_pose_limit(system).certified;
            const auto frame = limit * static_cast<Scalar>(random.uniform(0.3, 3));
            Promise<Stepper> promise;
            const double start = static_cast<double>(system.energy(state));
            promise.holds(start, 0);
            double most = start;
            bool ok = true;
            for (double t = 0; ok && t < seconds;) {
                // Late now and then, so that h changes.
                const Scalar span = random.below(4) == 0 ? frame * Scalar(1.3) : frame;
                ok = bool(guard.advance(state, span));
                if (!ok) break;
                const auto energy = static_cast<double>(system.energy(state));
                REQUIRE(promise.holds(energy, static_cast<double>(span)));
                most = std::max(most, energy);
                t += static_cast<double>(span);
            }
            finished += ok;
            if (ok) CHECK(most <= 4 * start);
        }
    }
    CHECK(finished > 50);
}

}  // namespace

TEMPLATE_TEST_CASE("guarded: no accepted frame breaks the promise where springs explode",
                   "[integrator][slow]", (Case<float, 1>), (Case<float, 2>), (Case<double, 2>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    using Plain = taut::SpringSystem<Scalar, TestType::Dim>;
    using Strings = taut::SpringSystem<Scalar, TestType::Dim, TensionOnly>;
    check_swung_masses<taut::SymplecticEuler<Plain>, Plain>(4);
    check_swung_masses<taut::VelocityVerlet<Plain>, Plain>(4);
    check_swung_masses<taut::SymplecticEuler<Strings>, Strings>(4);
    check_swung_masses<taut::VelocityVerlet<Strings>, Strings>(4);
}

TEST_CASE("guarded: edits between frames move the account by their energy, and renew no slack",
          "[integrator][slow]") {
    // The state is nudged, the spring changed and changed back: were the account opened anew, each
    // would forgive what the frame before had gained.
    using System = taut::SpringSystem<double, 2>;
    for (const int edit : {0, 1, 2, 3}) {
        INFO("edit " << edit);
        int broken = 0;
        for (std::uint32_t seed = 1; seed <= 40; ++seed) {
            Random random(seed);
            System::State state;
            System system = swung_mass<System>(random, 0, state);
            const double stiffness = system.springs().parameters[0].stiffness;
            Guarded<taut::SymplecticEuler<System>> guard(system);
            const double frame = 0.9 * taut::any_pose_limit(system).certified;
            const double start = system.energy(state);
            double given = 0;  // by the edits, J
            for (int i = 0; i < 600; ++i) {
                const double before = system.energy(state);
                if (edit == 0) state.v.col(1) *= 1 + 1e-12;
                if (edit == 1) system.set_stiffness(0, stiffness * (i % 2 == 0 ? 1.0001 : 1));
                if (edit == 2) system.set_gravity({0, i % 2 == 0 ? 1e-9 : 0});
                if (edit == 3) state.time = i;
                given += system.energy(state) - before;
                if (!guard.advance(state, frame)) break;
                broken += system.energy(state) > 4 * (start + std::abs(given));
            }
        }
        CHECK(broken == 0);
    }
}

TEMPLATE_TEST_CASE("guarded: a penalty floor gives back no more than fell on it", "[integrator]",
                   (taut::SymplecticEuler<taut::SpringSystem<float, 2>>),
                   (taut::VelocityVerlet<taut::SpringSystem<double, 2>>),
                   (taut::SymplecticEuler<taut::SpringSystem<double, 2>>)) {
    using Scalar = typename TestType::Scalar;
    using System = taut::SpringSystem<Scalar, 2>;
    int bounced = 0;
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        const double stiffness = log_uniform(random, 1e2, 1e8);
        INFO("seed " << seed << ", floor of " << stiffness << " N/m");
        System system;
        system.add_particle({0, Scalar(1)}, 1);
        system.add_particle({Scalar(0.5), Scalar(1)},
                            static_cast<Scalar>(log_uniform(random, 0.01, 10)));
        system.add_spring(0, 1, static_cast<Scalar>(log_uniform(random, 10, 1000)));
        system.set_gravity({0, Scalar(-9.81)});
        system.set_external_force([stiffness](const auto& s, auto& f) {
            for (Index i = 0; i < s.x.cols(); ++i) {
                if (s.x(1, i) < 0) f(1, i) -= static_cast<Scalar>(stiffness) * s.x(1, i);
            }
        });
        auto state = system.initial_state();
        state.v.row(1).setConstant(static_cast<Scalar>(-log_uniform(random, 0.1, 100)));
        Guarded<TestType> guard(system);
        const auto total = [&] {
            double floor = 0;
            for (Index i = 0; i < 2; ++i) {
                const double depth = std::min(0.0, static_cast<double>(state.x(1, i)));
                floor += 0.5 * stiffness * depth * depth;
            }
            return static_cast<double>(system.energy(state)) + floor;
        };
        const double start = total();
        for (int i = 0; i < 40; ++i) {
            const auto report = guard.advance(state, Scalar(1) / 60);
            if (!report) {
                CHECK(report.alarm != Alarm::none);
                break;
            }
            // The floor's own steps swing as a spring's do, within what counts as resolved.
            REQUIRE(total() <= 3 * start);
            bounced += state.v.row(1).maxCoeff() > 0;
        }
    }
    CHECK(bounced > 500);
}

TEST_CASE("guarded: a drag too strong for the step is stepped finer, or refused",
          "[integrator][slow]") {
    using System = taut::SpringSystem<double, 3>;
    for (const double drag : {1.0, 100.0, 1e4}) {
        taut::ClothOptions options;
        options.rows = options.columns = 6;
        auto cloth = taut::hanging_cloth<double>(options);
        cloth.set_external_force([drag](const auto& s, auto& f) { f -= drag * s.v; });
        auto state = cloth.initial_state();
        for (Index i = 0; i < cloth.size(); ++i) {
            if (!cloth.is_pinned(i)) state.v.col(i).setConstant(1);
        }
        const double start = cloth.energy(state);
        Guarded<taut::SymplecticEuler<System>> guard(cloth);
        for (int i = 0; i < 20; ++i) {
            if (!guard.advance(state, 1.0 / 60)) break;
            CHECK(cloth.energy(state) <= 1.02 * start);
        }
    }
}

namespace {

/// A small cloth that falls on a sphere: the highest energy above the start, as a share of the
/// largest kinetic and elastic energy that the fall can give.
template <class Stepper, class... Arguments>
double gain_on_a_sphere(double frame, int& accepted, const Arguments&... arguments) {
    taut::ClothOptions options;
    options.rows = options.columns = 8;
    options.mass = 0.01;
    options.pin_corners = false;
    const auto cloth = taut::hanging_cloth<double>(options);
    auto state = cloth.initial_state();
    const taut::Sphere<double, 3> ball({0.5, 0.5, -0.35}, 0.3);
    Guarded<Stepper> guard(cloth, {}, arguments...);
    const double start = cloth.energy(state);
    double gain = 0;
    for (double t = 0; t < 1.5; t += frame) {
        if (!guard.advance(state, frame, [&](auto& s) {
                (void)taut::resolve_contacts(cloth, ball, s, {0.3, 0});
            }))
            break;
        ++accepted;
        gain = std::max(gain, cloth.energy(state) - start);
    }
    return gain / (0.01 * 9.81 * 0.5);
}

}  // namespace

TEMPLATE_TEST_CASE("guarded: sound scenes are never given up, whatever works on them",
                   "[integrator]", (taut::SymplecticEuler<taut::SpringSystem<double, 2>>),
                   (taut::VelocityVerlet<taut::SpringSystem<double, 2>>)) {
    // A mass on a spring without energy at first, which gravity, a force, a pin or a drag moves.
    using System = taut::SpringSystem<double, 2>;
    for (int kind = 0; kind < 5; ++kind) {
        int given_up = 0;
        for (std::uint32_t seed = 1; seed <= 20; ++seed) {
            Random random(seed);
            System system;
            system.add_particle({0, 0}, 1);
            system.add_particle({0, -1}, 1);
            system.add_spring(0, 1, log_uniform(random, 2e3, 2e4));
            system.pin(0);
            auto state = system.initial_state();
            if (kind < 2) system.set_gravity({0, -9.81});
            if (kind == 1) system.set_rayleigh({1, 0});
            if (kind == 2) {
                system.set_external_force([](const auto&, auto& f) { f(1, 1) -= 9.81; });
            }
            if (kind == 3) state.v(1, 0) = 0.05;
            if (kind == 4) {
                system.set_external_force([](const auto& s, auto& f) { f -= 1.0 * s.v; });
                state.v(1, 1) = -10;
            }
            Guarded<TestType> guard(system);
            for (int i = 0; i < 600; ++i) given_up += !guard.advance(state, 1.0 / 60);
        }
        INFO("kind " << kind);
        CHECK(given_up == 0);
    }
}

TEST_CASE("guarded: a scene that is reset after a violent time goes on", "[integrator]") {
    using System = taut::SpringSystem<double, 3>;
    taut::ClothOptions options;
    options.rows = options.columns = 10;
    for (const bool still : {true, false}) {
        auto cloth = taut::hanging_cloth<double>(options);
        auto state = cloth.initial_state();
        Guarded<taut::SymplecticEuler<System>> guard(cloth);
        for (int i = 0; i < 120; ++i) {
            for (const Index corner : {Index(0), Index(9)}) {
                state.v(2, corner) = 8 * std::cos(0.2 * i);
            }
            REQUIRE(guard.advance(state, 1.0 / 60));
        }
        const double time = state.time;
        state = cloth.initial_state();
        if (!still) state.v.setConstant(1e-3);
        for (Index i = 0; i < cloth.size(); ++i) {
            if (cloth.is_pinned(i)) state.v.col(i).setZero();
        }
        state.time = time;
        int retries = 0;
        for (int i = 0; i < 900; ++i) {
            const auto report = guard.advance(state, 1.0 / 60);
            REQUIRE(report);
            retries += report.retries;
        }
        CHECK(retries <= 9);
    }
}

TEST_CASE("guarded: positions pushed out of an obstacle give no energy", "[integrator][slow]") {
    using System = taut::SpringSystem<double, 3>;
    using Implicit = taut::ImplicitEuler<System>;
    int accepted = 0;
    for (const double frame : {1.0 / 60, 1.0 / 240}) {
        INFO("frame " << frame);
        CHECK(gain_on_a_sphere<Implicit>(frame, accepted) < 0.02);
        CHECK(gain_on_a_sphere<taut::NewtonEuler<System>>(frame, accepted) < 0.02);
        CHECK(gain_on_a_sphere<taut::Bdf2<System>>(frame, accepted) < 0.02);
        CHECK(gain_on_a_sphere<taut::SymplecticEuler<System>>(frame, accepted) < 0.02);
    }
    CHECK(accepted > 500);
}

}  // namespace taut_test::guarded_promise_test
