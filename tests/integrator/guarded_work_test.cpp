// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What a guard counts as work, and so not as a rise of the energy.
#include <cmath>
#include <taut/integrator/guarded.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/newton/newton.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/contact/contact.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::guarded_work_test {

using taut::Alarm;
using taut::Guarded;

namespace {

using Cloth = taut::SpringSystem<double, 3>;
using Springs = taut::SpringSystem<double, 2>;
using Symplectic = Guarded<taut::SymplecticEuler<Springs>>;

constexpr double frame = 1.0 / 60;  // s

}  // namespace

TEST_CASE("guarded: stiff springs to the outside on every particle cost retries and no refusal",
          "[integrator]") {
    // What symplectic Euler keeps contains their power, which the audit leaves out: with it, it
    // would not see them explode.
    Random random(10);
    RandomOptions options;
    options.gravity = false;
    auto system = random_system<double, 2>(random, options);
    const auto home = system.initial_state().x;
    const double h = 0.95 * taut::any_pose_limit(system).certified;
    const double stiffness = 0.2 / (h * h);
    system.set_external_force(
        [home, stiffness](const auto& state, auto& f) { f -= stiffness * (state.x - home); });
    auto state = system.initial_state();
    state.x.rightCols(4).array() += 0.05;
    Symplectic guard(system);
    for (int i = 0; i < 60; ++i) REQUIRE(guard.advance(state, 10 * frame));
}

TEMPLATE_TEST_CASE("guarded: the work of moving pins through dampers is in the books",
                   "[integrator]", taut::SymplecticEuler<Springs>, taut::ImplicitEuler<Springs>) {
    for (const bool rayleigh : {false, true}) {
        Springs system;
        for (const double x : {0.0, 0.5, 1.0}) system.add_particle({x, 0}, 1);
        system.add_spring(0, 1, 50, rayleigh ? 0 : 10);
        system.add_spring(1, 2, 50, rayleigh ? 0 : 10);
        if (rayleigh) system.set_rayleigh({0, 0.2});
        system.pin(0);
        auto state = system.initial_state();
        state.v(0, 0) = -1;
        Guarded<TestType> guard(system);
        for (int i = 0; i < 60; ++i) REQUIRE(guard.advance(state, frame));
        CHECK(state.v(0, 2) < -0.1);
    }
}

TEST_CASE("guarded: the work of forces and of moving pins is no alarm", "[integrator]") {
    Random random(6);
    RandomOptions options;
    options.gravity = false;
    auto system = random_system<double, 2>(random, options);
    system.set_external_force([](const auto&, auto& f) { f.array() += 3.0; });
    auto state = system.initial_state();
    REQUIRE(taut::VelocityVerlet(system).step(state, 1e-3, 10));
    Symplectic::Options options_of_guard;
    options_of_guard.max_step = frame / 16;  // else it is springs that crumple that cost retries
    Symplectic guard(system, options_of_guard);
    for (int i = 0; i < 60; ++i) {
        state.v(0, 0) = 0.5 * std::sin(0.1 * i);
        const auto report = guard.advance(state, frame);
        REQUIRE(report);
        CHECK(report.retries == 0);
    }
}

TEST_CASE("guarded: the work of a push within a frame is in the books", "[integrator]") {
    Random random(7);
    auto system = random_system<double, 2>(random);
    auto state = system.initial_state();
    // A push in the middle of the frame: neither end of it shows a force.
    system.set_external_force([](const auto& s, auto& f) {
        if (s.time > 0.25 * frame && s.time < 0.75 * frame) f.col(5).array() += 2e3;
    });
    Symplectic::Options options;
    options.max_step = frame / 1024;
    options.max_substeps = 2048;
    Symplectic guard(system, options);
    const auto report = guard.advance(state, frame);
    CHECK(report);
    CHECK(report.retries == 0);
    CHECK(report.work > 1);
    CHECK(state.v.col(5).norm() > 1);
}

TEST_CASE("guarded: contacts within a frame are kept, and their energy is no alarm",
          "[integrator][slow]") {
    taut::ClothOptions options;
    options.rows = options.columns = 12;
    auto cloth = taut::hanging_cloth<double>(options);
    for (Index i = 0; i < cloth.size(); ++i) cloth.unpin(i);
    auto state = cloth.initial_state();
    const Eigen::Vector3d up = -cloth.gravity().normalized();
    const auto lowest = [&] { return (up.transpose() * state.x).minCoeff(); };
    const double ground = lowest() - 0.02;
    const taut::HalfSpace<double, 3> floor(ground * up, up);
    Guarded<taut::SymplecticEuler<Cloth>> guard(cloth);
    Index contacts = 0;
    for (int i = 0; i < 60; ++i) {
        const auto report = guard.advance(state, frame, [&](auto& s) {
            contacts += taut::resolve_contacts(cloth, floor, s, {0.3, 0}).contacts;
        });
        REQUIRE(report);
        CHECK(lowest() >= ground - Tolerance<double>::rounding);
    }
    CHECK(contacts > 0);
    // Energy that a response gives is a gain, unless the response says that it is work.
    const auto before = state;
    const auto lift = [&](auto& s) {
        const double kinetic = cloth.kinetic_energy(s);
        s.v.colwise() += 0.1 * up;
        return cloth.kinetic_energy(s) - kinetic;
    };
    auto unclaimed = guard.advance(state, frame, [&](auto& s) { (void)lift(s); });
    CHECK_FALSE(unclaimed);
    CHECK(unclaimed.alarm == Alarm::response);
    CHECK(unclaimed.response > 0);
    CHECK(same_bits(state, before));
    const auto claimed = guard.advance(state, frame, lift);
    CHECK(claimed);
    CHECK(claimed.work > 0);
}

TEST_CASE("guarded: a stepper's own options, and the work of its constraints", "[integrator]") {
    Random random(11);
    RandomOptions options;
    options.gravity = false;
    const auto system = random_system<double, 2>(random, options);
    using Stepper = taut::NewtonEuler<Springs>;
    Stepper::Options newton;
    newton.iterations = 40;
    Guarded<Stepper> guard(system, {}, newton);
    Stepper alone(system, newton);
    auto state = system.initial_state();
    for (auto* stepper : {&guard.stepper(), &alone}) {
        stepper->constraints().prescribe(5, {2, 0});
    }
    auto expected = state;
    int same = 0;
    double most = 0;
    for (int i = 0; i < 30; ++i) {
        const auto report = guard.advance(state, frame);
        REQUIRE(report);
        if (report.retries == 0) {
            REQUIRE(alone.step(expected, frame));
            CHECK(same_bits(state, expected));
            ++same;
        }
        expected = state;
        most = std::max(most, system.energy(state));
    }
    CHECK(same > 0);
    CHECK(most > 1);  // J: the constraint has done work
}

}  // namespace taut_test::guarded_work_test
