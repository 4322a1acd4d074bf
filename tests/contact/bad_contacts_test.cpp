// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/contact/contact.hpp>
#include <taut/contact/self_contact.hpp>
#include <taut/guard/guard.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"
#include "bodies.hpp"

namespace taut_test::bad_contacts_test {

namespace {

using Cloth = decltype(taut::hanging_cloth<float>({12, 12}));
using Vector = Eigen::Vector3f;
using Place = taut::Pose<float, 3>;

Place at(float x, float y, float z) {
    Place pose;
    pose.position = {x, y, z};
    return pose;
}

/// The middle of all particles, m.
Vector middle(const Cloth& cloth) { return cloth.initial_state().x.rowwise().mean(); }

/// Across it, of length 1.
Vector across(const Cloth& cloth) {
    const auto x = cloth.initial_state().x;
    return Vector(x.col(1) - x.col(0)).cross(Vector(x.col(12) - x.col(0))).normalized();
}

/// Frames of a guard, each of which must stand. @returns the highest speed, m/s
template <class Move>
float run(Cloth& cloth, taut::Contacts<Cloth>& contacts, Cloth::State& state, int frames,
          const Move& move) {
    taut::Guarded guard(cloth);
    float fastest = 0;
    for (int f = 0; f < frames; ++f) {
        move(f);
        REQUIRE(guard.advance(state, 1.0f / 60, contacts));
        REQUIRE(state.finite());
        fastest = std::max(fastest, state.v.colwise().norm().maxCoeff());
    }
    return fastest;
}

}  // namespace

TEST_CASE("bad contacts: what is out of range is refused by name, and changes nothing",
          "[contact]") {
    const auto cloth = taut::hanging_cloth<float>({12, 12});
    taut::Contacts contacts(cloth);
    const taut::Sphere<float, 3> ball({0, 0, 0}, 0.1f);
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = 1 / 0.0f;
    const auto refuses = [&](double taut::BodyOptions::*what, double value, const char* name) {
        taut::BodyOptions options;
        options.*what = value;
        CHECK_THROWS_WITH(contacts.add(ball, options), Catch::Contains(name));
    };
    for (const float bad : {-1.0f, nan, infinity}) {
        refuses(&taut::BodyOptions::friction, double(bad), "friction");
        refuses(&taut::BodyOptions::thickness, double(bad), "thickness");
        refuses(&taut::BodyOptions::push_out, double(bad), "push_out");
        CHECK_THROWS_WITH(contacts.set_stiffness(bad), Catch::Contains("set_stiffness"));
    }
    refuses(&taut::BodyOptions::push_out, 0, "push_out");
    CHECK_THROWS_WITH(contacts.set_stiffness(0), Catch::Contains("set_stiffness"));
    CHECK_THROWS_WITH(contacts.move_to(0, {}), Catch::Contains("no body 0"));
    CHECK_THROWS_WITH(contacts.add(ball, {}, at(nan, 0, 0)), Catch::Contains("Contacts::add"));
    const float chosen = contacts.stiffness();
    const auto limit = taut::energy_limit(cloth).certified;
    CHECK_THAT(chosen * limit * limit, WithinRel(100.0f, 1e-5f));

    // One that is refused leaves the next frame as it would have been.
    auto state = cloth.initial_state();
    auto same = state;
    taut::Contacts others(cloth);
    for (auto* each : {&contacts, &others}) each->add(ball, {}, at(0, 0, 9));
    Place sheared = at(0, 0, 8);
    sheared.rotation(0, 1) = 0.5f;
    for (const Place& bad : {at(0, nan, 0), at(infinity, 0, 0), sheared}) {
        CHECK_THROWS_WITH(contacts.move_to(0, bad), Catch::Contains("Contacts::move_to"));
    }
    taut::Guarded guard(cloth), guard_of_others(cloth);
    REQUIRE(guard.advance(state, 1.0f / 60, contacts));
    REQUIRE(guard_of_others.advance(same, 1.0f / 60, others));
    CHECK(same_bits(state, same));
}

TEST_CASE("bad contacts: a body that starts inside or around a cloth lets it out gently",
          "[contact]") {
    for (const float radius : {0.05f, 0.3f, 3.0f}) {
        auto cloth = taut::hanging_cloth<float>({12, 12});
        cloth.set_gravity({0, 0, 0});
        for (Index i = 0; i < cloth.size(); ++i) cloth.unpin(i);
        taut::Contacts contacts(cloth);
        taut::BodyOptions options;
        options.push_out = 0.5;
        contacts.add(taut::Sphere<float, 3>(middle(cloth) + radius / 2 * across(cloth), radius),
                     options);
        auto state = cloth.initial_state();
        const float fastest = run(cloth, contacts, state, 600, [](int) {});
        CHECK(fastest < 4 * 0.5f);  // springs that were stretched pull, too
        CHECK(contacts.deepest() < 1e-3f);
    }
}

TEST_CASE("bad contacts: a body that jumps ten metres, twice its width in a step, passes nothing",
          "[contact]") {
    auto cloth = taut::hanging_cloth<float>({12, 12});
    for (Index i = 0; i < cloth.size(); ++i) cloth.unpin(i);
    const Vector centre = middle(cloth), out = across(cloth);
    taut::Contacts contacts(cloth);
    Place pose{centre - out, Eigen::Quaternionf::FromTwoVectors(Vector::UnitZ(), out).matrix()};
    const auto plate = contacts.add(taut::Box<float, 3>({0.25f, 0.25f, 0.05f}), {}, pose);
    auto state = cloth.initial_state();
    run(cloth, contacts, state, 1, [&](int) {
        pose.position = centre + 9 * out;
        contacts.move_to(plate, pose);
    });
    Index hit = 0, passed = 0;
    for (Index i = 0; i < cloth.size(); ++i) {
        const Vector from = cloth.initial_state().x.col(i) - centre,
                     to = pose.inside(state.x.col(i));
        if (!(from.norm() < 0.2f)) continue;
        ++hit;
        passed += to.head<2>().cwiseAbs().maxCoeff() < 0.25f && to[2] < 0;
    }
    CHECK(hit > 3);
    CHECK(passed == 0);
    CHECK(contacts.work() > 0);
}

TEST_CASE("bad contacts: two bodies squeeze a cloth, and one holds a pin", "[contact]") {
    auto cloth = taut::hanging_cloth<float>({12, 12});
    const Vector centre = middle(cloth), pin = cloth.initial_state().x.col(0);
    taut::Contacts contacts(cloth);
    const auto left = contacts.add(taut::Box<float, 3>({0.2f, 0.2f, 0.2f}));
    const auto right = contacts.add(taut::Sphere<float, 3>({0, 0, 0}, 0.2f));
    contacts.add(taut::Sphere<float, 3>(pin, 0.1f));
    auto state = cloth.initial_state();
    run(cloth, contacts, state, 240, [&](int f) {
        const float apart = 0.5f - 0.005f * float(f);  // in the end each is where the other was
        contacts.move_to(left,
                         Place{centre - Vector(apart, 0, apart), Place::Rotation::Identity()});
        contacts.move_to(right,
                         Place{centre + Vector(apart, 0, apart), Place::Rotation::Identity()});
    });
    CHECK(state.x.cwiseAbs().maxCoeff() < 10);
}

TEMPLATE_TEST_CASE("bad contacts: a step that is taken anew has no contact of the first time in it",
                   "[contact]", float, double) {
    // Two particles in one register, pushed by a ball each, the first one onto a third ball that
    // the lists do not have: H may rise by the balls' work alone.
    using System = taut::SpringSystem<TestType, 2>;
    using Place2 = taut::Pose<TestType, 2>;
    using Vector2 = Eigen::Matrix<TestType, 2, 1>;
    Random random(5);
    for (int scene = 0; scene < 50; ++scene) {
        System system;
        system.add_particle({0, 0}, 1);
        system.add_particle({5, 0}, 1);
        system.add_spring(0, 1, {100});
        taut::Contacts contacts(system);
        taut::EnergyStableEuler stepper(system);
        const auto at = [](double x, double y) {
            Place2 pose;
            pose.position = Vector2(TestType(x), TestType(y));
            return pose;
        };
        const taut::Sphere<TestType, 2> ball({0, 0}, TestType(0.3));
        contacts.add(ball, {}, at(0, -0.301));
        contacts.add(ball, {}, at(5, -0.2999));
        contacts.add(ball, {}, at(0, 0.3 + random.uniform(0.1, 0.2)));
        auto state = system.initial_state();
        const TestType h = taut::energy_limit(system).certified;
        double before = system.energy(state);
        for (const double held : contacts.open(state)) before += held;
        contacts.move_to(0, at(0, -0.301 + random.uniform(0.05, 0.15)));
        REQUIRE(taut::step_through(stepper, state, h, 1, contacts));
        CHECK(system.energy(state) + contacts.energy() <= before + contacts.work() + 1e-4);
    }
}

TEST_CASE("bad contacts: those of another system are refused by name", "[contact][bad_input]") {
    const auto small = taut::hanging_cloth<float>({5, 5}), big = taut::hanging_cloth<float>({9, 9});
    taut::Contacts contacts(small);
    contacts.add(taut::Sphere<float, 3>({0, 0, 0}, 1));
    auto state = big.initial_state();
    const auto start = state;
    const auto says = [&](const char* name, auto call) {
        CHECK(missing(message_of([&] { call(); }), {name, "another system"}) == "");
        CHECK((state.x == start.x && state.v == start.v));
    };
    taut::Guarded guard(big);
    taut::EnergyStableEuler stepper(big);
    taut::SelfContact self(small);
    says("Guarded::advance", [&] { (void)guard.advance(state, 1.0f / 60, contacts); });
    says("Guarded::advance", [&] { (void)guard.advance(state, 1.0f / 60, self); });
    says("Contacts", [&] { (void)step_through(stepper, state, 1e-3f, 2, contacts); });
    says("SelfContact", [&] { (void)step_through(stepper, state, 1e-3f, 2, self); });
    says("SelfContact", [&] { taut::SelfContact(big, contacts); });
}

TEST_CASE("bad contacts: a rotation that is one but for rounding does no work", "[contact]") {
    taut::SpringSystem<double, 3> system;
    for (int i = 0; i < 4; ++i) system.add_particle({1000 + 0.1 * i, 0, 0}, 1);
    for (int i = 0; i < 3; ++i) system.add_spring(i, i + 1, {100});
    for (const double off : {-2.5e-4, -1e-5, 1e-7, 2.5e-4}) {
        taut::Contacts contacts(system);
        taut::Pose<double, 3> pose;
        pose.rotation *= 1 + off;
        contacts.add(taut::HalfSpace<double, 3>({1000, 0, 0}, {-1, 0, 0}), {}, pose);
        contacts.move_to(0, pose);
        taut::EnergyStableEuler stepper(system);
        auto state = system.initial_state();
        for (int f = 0; f < 20; ++f)
            REQUIRE(
                step_through(stepper, state, taut::energy_limit(system).certified, 5, contacts));
        CHECK(std::abs(contacts.work()) < 1e-9);
    }
}

TEMPLATE_TEST_CASE("bad contacts: particles without a spring lie on the floor", "[contact]", float,
                   double) {
    taut::SpringSystem<TestType, 3> system;
    system.add_particle({0, 0, TestType(0.1)}, 1);
    system.set_gravity({0, 0, TestType(-9.81)});
    taut::Contacts contacts(system);
    contacts.add(taut::HalfSpace<TestType, 3>({0, 0, 0}, {0, 0, 1}));
    CHECK(contacts.stiffness() > 0);
    contacts.set_stiffness(TestType(1e30));  // no more than rounding bears
    taut::EnergyStableEuler stepper(system);
    auto state = system.initial_state();
    for (int f = 0; f < 60; ++f)
        REQUIRE(step_through(stepper, state, TestType(1) / 600, 10, contacts));
    CHECK(std::abs(state.x(2, 0)) < TestType(1e-3));
}

}  // namespace taut_test::bad_contacts_test
