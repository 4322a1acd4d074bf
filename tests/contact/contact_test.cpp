// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <string>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/between/between.hpp>
#include <taut/contact/contact.hpp>
#include <taut/scene/cloth.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/direct_euler.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::contact_test {

using taut::HalfSpace;
using taut::resolve_contacts;
using taut::Sphere;

namespace {

/// Checks what every obstacle is promised, on random crumpled states.
template <class Scalar, int Dim, class Obstacle>
void check_contacts(const Obstacle& obstacle) {
    int touched = 0;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const auto system = random_system<Scalar, Dim>(random);
        const auto before = random_state(random, system);
        auto state = before;
        const double friction = random.uniform(0, 1);
        const double thickness = seed % 2 == 0 ? 0.05 : 0;
        const auto report = resolve_contacts(system, obstacle, state, {friction, thickness});
        Eigen::Matrix<double, Dim, 1> impulse = Eigen::Matrix<double, Dim, 1>::Zero();
        Index contacts = 0;
        for (Index i = 0; i < system.size(); ++i) {
            const auto was = obstacle.surface(before.x.col(i));
            if (system.is_pinned(i) || static_cast<double>(was.distance) > thickness) {
                CHECK((state.x.col(i) == before.x.col(i)));
                CHECK((state.v.col(i) == before.v.col(i)));
                continue;
            }
            ++contacts;
            const auto now = obstacle.surface(state.x.col(i));
            CHECK_THAT(static_cast<double>(now.distance),
                       WithinAbs(thickness, Tolerance<Scalar>::rounding));
            CHECK(distance(now.normal, was.normal) <= Tolerance<Scalar>::rounding);
            const Eigen::Matrix<double, Dim, 1> n = was.normal.template cast<double>();
            const Eigen::Matrix<double, Dim, 1> push =
                (state.v.col(i) - before.v.col(i)).template cast<double>();
            const double into = -n.dot(before.v.col(i).template cast<double>());
            const double along = (push - n.dot(push) * n).norm();
            CHECK(state.v.col(i).norm() <= before.v.col(i).norm());
            CHECK_THAT(n.dot(push), WithinAbs(std::max(0.0, into), Tolerance<Scalar>::rounding));
            CHECK(along <= friction * std::max(0.0, into) + Tolerance<Scalar>::rounding);
            if (into > 0 && state.v.col(i).norm() > Scalar(1e-3)) {  // it slides on
                CHECK_THAT(along, WithinAbs(friction * into, Tolerance<Scalar>::rounding));
            }
            impulse += static_cast<double>(system.mass(i)) * push;
            touched += into > 0 ? 1 : 0;
        }
        CHECK(report.contacts == contacts);
        CHECK((report.deepest >= 0) == (contacts > 0));
        CHECK(distance(report.impulse, impulse) <= Tolerance<Scalar>::rounding);
    }
    CHECK(touched > 10);
}

/// An obstacle of the user's own: all that is outside of a ball.
struct Bowl {
    taut::Surface<double, 3> surface(const Eigen::Vector3d& x) const {
        return {1.1 - x.norm(), -x.normalized()};
    }
};

}  // namespace

TEMPLATE_TEST_CASE("contact: particles come out along the normal and lose what Coulomb says",
                   "[contact]", (Case<float, 2>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    check_contacts<Scalar, Dim>(
        HalfSpace<Scalar, Dim>(Vector::Constant(Scalar(0.1)), Vector::Constant(Scalar(3))));
    check_contacts<Scalar, Dim>(Sphere<Scalar, Dim>(Vector::Constant(Scalar(0.25)), Scalar(0.9)));
}

TEST_CASE("contact: an obstacle of the user's own serves as well", "[contact]") {
    check_contacts<double, 3>(Bowl{});
}

TEST_CASE("contact: a particle on a slope slides, or stays, by the tangent of its angle",
          "[contact]") {
    const double g = 9.81;
    const double friction = 0.5;
    for (const double angle : {0.2, 0.4, 0.6, 1.0}) {
        taut::SpringSystem<double, 2> system;
        system.add_particle({0, 0}, 0.7);
        system.set_gravity({0, -g});
        const HalfSpace<double, 2> slope({0, 0}, {std::sin(angle), std::cos(angle)});
        auto state = system.initial_state();
        taut::SymplecticEuler stepper(system);
        const double h = 0.01;
        for (int i = 0; i < 100; ++i) {
            REQUIRE(stepper.step(state, h));
            const auto report = resolve_contacts(system, slope, state, {friction, 0});
            CHECK(report.contacts == 1);
        }
        const double pull = g * (std::sin(angle) - friction * std::cos(angle));
        const double speed = std::tan(angle) > friction ? pull * 100 * h : 0;
        CHECK_THAT(state.v.col(0).norm(), WithinAbs(speed, Tolerance<double>::accumulated));
        CHECK_THAT(slope.surface(state.x.col(0)).distance,
                   WithinAbs(0, Tolerance<double>::accumulated));
    }
}

TEST_CASE("contact: a particle on the surface is stopped, and weighs on it", "[contact]") {
    taut::SpringSystem<double, 3> system;
    system.add_particle({0.3, 0.2, 0}, 0.7);
    system.set_gravity({0, 0, -9.81});
    const HalfSpace<double, 3> floor({0, 0, 0}, {0, 0, 2});
    auto state = system.initial_state();
    state.v.col(0) << 0, 0, -9.81 * 0.01;
    for (const bool below : {false, true}) {
        if (below) REQUIRE(taut::SymplecticEuler(system).step(state, 0.01));
        const auto report = resolve_contacts(system, floor, state, {0.4, 0});
        CHECK(report.contacts == 1);
        CHECK(distance(report.impulse, Eigen::Vector3d(0, 0, 0.7 * 9.81 * 0.01)) <=
              Tolerance<double>::rounding);
        CHECK(state.v.col(0).norm() == 0);
        CHECK(state.x(2, 0) == 0);
    }
}

TEMPLATE_TEST_CASE("contact: from the middle of a sphere the way out is the last axis", "[contact]",
                   float, double) {
    taut::SpringSystem<TestType, 2> system;
    system.add_particle({1, 2}, 1);
    auto state = system.initial_state();
    const auto report = resolve_contacts(system, Sphere<TestType, 2>({1, 2}, TestType(0.5)), state);
    CHECK(report.depth == TestType(0.5));
    CHECK(report.deepest == 0);
    CHECK((state.x.col(0) == Eigen::Matrix<TestType, 2, 1>(1, 2.5)));
    CHECK((state.v.col(0).array() == 0).all());
}

TEST_CASE("contact: a cloth falls on a sphere, hangs over it and comes to rest",
          "[contact][slow]") {
    taut::ClothOptions options;
    options.rows = options.columns = 17;
    options.pin_corners = false;
    auto cloth = taut::hanging_cloth<double>(options);
    cloth.set_rayleigh({1, 0.002});
    const Sphere<double, 3> ball({0.5, 0.5, -0.5}, 0.3);
    auto state = cloth.initial_state();
    DirectEuler stepper(cloth);
    // 3 s: later rounding decides which way so symmetric a cloth tips from its balance on the ball.
    for (int i = 0; i < 180; ++i) {
        REQUIRE(stepper.step(state, 1.0 / 60));
        resolve_contacts(cloth, ball, state, {0.6, 0.01});
        for (Index p = 0; p < cloth.size(); ++p) {
            REQUIRE(ball.surface(state.x.col(p)).distance > 0.01 - Tolerance<double>::accumulated);
        }
    }
    CHECK(state.v.colwise().norm().maxCoeff() < 0.005);
    CHECK_THAT(state.x.row(2).maxCoeff(), WithinAbs(-0.19, 0.02));  // on top of it
    CHECK(state.x.row(2).minCoeff() < -0.4);                        // the corners hang
}

TEST_CASE("contact: obstacles and options out of range are refused by name",
          "[contact][bad_input]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    using Plane = HalfSpace<double, 3>;
    using Ball = Sphere<double, 3>;
    const auto says = [](std::initializer_list<const char*> words, auto build) {
        CHECK(missing(message_of([&] { build(); }), words) == "");
    };
    says({"HalfSpace", "normal"}, [] { Plane({0, 0, 0}, {0, 0, 0}); });
    says({"HalfSpace", "normal"}, [&] { Plane({0, 0, 0}, {0, nan, 1}); });
    says({"HalfSpace", "point"}, [&] { Plane({nan, 0, 0}, {0, 0, 1}); });
    CHECK_NOTHROW(Plane({0, 0, 0}, {0, 0, 1e-200}));
    says({"Sphere", "radius is 0"}, [] { Ball({0, 0, 0}, 0); });
    says({"Sphere", "centre"}, [&] { Ball({0, 0, nan}, 1); });
    Random random(1);
    const auto system = random_system<double, 3>(random);
    auto state = system.initial_state();
    const auto resolve = [&](taut::ContactOptions options) {
        return [&, options] { resolve_contacts(system, Ball({0, 0, 0}, 1), state, options); };
    };
    says({"friction is -1"}, resolve({-1, 0}));
    says({"thickness is nan"}, resolve({0, nan}));
    state.x.conservativeResize(3, 4);
    says({"resolve_contacts", "4 positions", "8 particles"}, resolve({}));
}

TEMPLATE_TEST_CASE("contact: between steps as on the state after each", "[contact]",
                   (Case<float, 2>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(7);
    const auto system = random_system<Scalar, Dim>(random);
    const auto start = random_state(random, system);
    const Sphere<Scalar, Dim> ball(random.vector<Scalar, Dim>(-1, 1), Scalar(0.8));
    const taut::ContactOptions options{0.25, 0.01};
    taut::SymplecticEuler first(system), second(system);
    auto alone = start, together = start;
    Index touched = 0;
    std::vector<taut::ContactReport<Scalar, Dim>> met;
    for (int step = 0; step < 20; ++step) {
        REQUIRE(first.step(alone, Scalar(0.001)));
        met.push_back(resolve_contacts(system, ball, alone, options));
        touched += met.back().contacts;
    }
    CHECK(touched > 0);
    std::size_t step = 0;
    REQUIRE(step_between(second, together, Scalar(0.001), 20, [&](auto& now) {
        const auto report = resolve_contacts(system, ball, now, options);
        CHECK(report.contacts == met[step].contacts);
        CHECK(report.deepest == met[step].deepest);
        CHECK(report.depth == met[step].depth);
        CHECK(report.impulse == met[step].impulse);
        ++step;
    }));
    CHECK(same_bits(together, alone));

    auto other = system;
    other.add_particle(random.vector<Scalar, Dim>(-1, 1), Scalar(1));
    const auto wrong = [&](auto& now) { resolve_contacts(other, ball, now); };
    CHECK(message_of([&] { (void)step_between(first, alone, Scalar(0.001), 1, wrong); }) ==
          "taut::resolve_contacts: " + std::to_string(system.size()) +
              " particles between steps, " + std::to_string(other.size()) + " in the system");
}

}  // namespace taut_test::contact_test
