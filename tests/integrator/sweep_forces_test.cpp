// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/explicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/scene/cloth.hpp>

#include <stdexcept>
#include <vector>

#include "../support/catch.hpp"
#include "../support/sweep_checks.hpp"

namespace taut_test::sweep_forces_test {

namespace {

template <class System>
void check_all_steppers(const System& system, const typename System::State& start) {
    check_equals_plain_path<taut::SymplecticEuler>(system, start);
    check_equals_plain_path<taut::ExplicitEuler>(system, start);
    check_equals_plain_path<taut::VelocityVerlet>(system, start);
    check_equals_plain_path<taut::SymplecticEuler>(system, start, {0.3, 0.5});
    check_equals_plain_path<taut::VelocityVerlet>(system, start, {0.3, 0});
}

/// A wind that is felt, on `count` triangles, whose corners are near each other or anywhere.
template <class Scalar>
taut::Wind<Scalar> draw_wind(Random& random, Index particles, int count) {
    taut::Wind<Scalar> wind;
    wind.velocity = random.vector<Scalar, 3>(-9, 9);
    wind.drag = random.uniform(0.1, 2);
    wind.lift = random.below(3) == 0 ? 0 : random.uniform(0.1, 2);
    while (static_cast<int>(wind.triangles.size()) < count) {
        const Index reach = random.below(4) == 0 ? particles : std::min<Index>(particles, 60);
        const Index first = random.below(particles);
        taut::Triangle triangle;
        for (Index& corner : triangle) corner = (first + random.below(reach)) % particles;
        wind.triangles.push_back(triangle);
        if (random.below(9) == 0) wind.triangles.push_back(triangle);
        if (random.below(3) == 0) {  // a neighbour, and one turned over
            wind.triangles.push_back({triangle[1], triangle[0], (first + 7) % particles});
        }
    }
    return wind;
}

}  // namespace

TEMPLATE_TEST_CASE("sweep: wind acts as on the plain path", "[integrator]", float, double) {
    Random random(91);
    for (const int triangles : {1, 2, 5, 300, 2600}) {
        CAPTURE(triangles);
        auto mesh = irregular<TestType, 3>(random, 2500, triangles == 300);
        auto grid = net<TestType, 3>(random, 47, 53);
        for (auto* system : {&grid, &mesh}) {
            system->set_wind(draw_wind<TestType>(random, system->size(), triangles));
            check_all_steppers(*system, random_state(random, *system));
        }
    }
}

TEMPLATE_TEST_CASE("sweep: wind on a cloth's own triangles acts as on the plain path",
                   "[integrator]", float, double) {
    Random random(92);
    for (const Index rows : {2, 9, 50}) {
        taut::ClothOptions options;
        options.rows = rows;
        options.columns = 53;
        options.mass = 40;
        options.stretch = 20;
        options.bend = 2;
        auto cloth = taut::hanging_cloth<TestType>(options);
        taut::Wind<TestType> wind;
        wind.velocity = {3, -2, 5};
        wind.triangles = taut::cloth_triangles(options);
        CHECK(static_cast<Index>(wind.triangles.size()) == 2 * (rows - 1) * 52);
        cloth.set_wind(wind);
        auto start = random_state(random, cloth);
        start.x = cloth.initial_state().x;
        check_all_steppers(cloth, start);
    }
}

TEST_CASE("sweep: a wind that comes, turns, moves to other triangles and ends is followed",
          "[integrator]") {
    Random random(93);
    for (const bool stars : {false, true}) {
        auto system =
            stars ? irregular<double, 3>(random, 2300, false) : net<double, 3>(random, 48, 48);
        taut::SymplecticEuler stepper(system);
        auto state = random_state(random, system);
        auto expected = state;
        const auto check = [&] {
            REQUIRE(stepper.step(state, 1e-3, 3));
            plain_steps<taut::Method::symplectic_euler>(system, expected, 1e-3, 3);
            CHECK(distance(state.v, expected.v) <= 1e-12 * largest(expected.v));
        };
        check();
        system.set_wind(draw_wind<double>(random, system.size(), 500));
        check();
        system.set_wind_velocity({-4, 5, 6});
        check();
        system.set_wind(draw_wind<double>(random, system.size(), 90));
        check();
        system.add_spring(3, 2100, 50.0);
        check();
        system.set_wind(taut::Wind<double>());
        check();
        CHECK_FALSE(system.has_external_force());
    }
}

TEMPLATE_TEST_CASE("sweep: forces on each particle and constant ones act as on the plain path",
                   "[integrator]", (Case<float, 2>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(94);
    auto grid = net<Scalar, TestType::Dim>(random, 50, 50);
    auto mesh = irregular<Scalar, TestType::Dim>(random, 2500, true);
    for (auto* system : {&grid, &mesh}) {
        const auto start = random_state(random, *system);
        system->set_particle_force([](const auto& x, const auto& v, Index i) {
            return (Scalar(0.5) * x.array() - Scalar(0.3) * v.array() + Scalar(i % 7)).matrix();
        });
        check_all_steppers(*system, start);
        for (int k = 0; k < 300; ++k) {
            system->set_constant_force(random.below(system->size()),
                                       random.vector<Scalar, TestType::Dim>(-9, 9));
        }
        check_all_steppers(*system, start);
        system->set_external_force([](const auto& state, auto& f) { f -= state.v; });
        check_all_steppers(*system, start);
        system->set_particle_force(nullptr);
        // A particle that came after the constant forces has none.
        system->add_particle(random.vector<Scalar, TestType::Dim>(-1, 1), Scalar(1));
        check_all_steppers(*system, random_state(random, *system));
    }
}

TEST_CASE("sweep: a force on a particle that throws leaves nothing behind", "[integrator]") {
    Random random(95);
    for (const bool stars : {false, true}) {
        auto system =
            stars ? irregular<double, 3>(random, 2300, false) : net<double, 3>(random, 48, 48);
        taut::SymplecticEuler stepper(system);
        const auto start = random_state(random, system);
        auto state = start;
        system.set_particle_force([](const auto& x, const auto&, Index i) {
            if (i == 1234) throw std::runtime_error("enough");
            return (0 * x).eval();
        });
        CHECK_THROWS_AS(static_cast<void>(stepper.step(state, 1e-3, 2)), std::runtime_error);
        CHECK(state.x == start.x);
        system.set_particle_force(nullptr);
        REQUIRE(stepper.step(state, 1e-3, 2));
        auto expected = start;
        plain_steps<taut::Method::symplectic_euler>(system, expected, 1e-3, 2);
        CHECK(distance(state.v, expected.v) <= 1e-12 * largest(expected.v));
    }
}

}  // namespace taut_test::sweep_forces_test
