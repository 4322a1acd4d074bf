// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/explicit_euler.hpp>
#include <taut/guard/guard.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/wind/wind.hpp>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "../support/catch.hpp"
#include "../support/direct_euler.hpp"
#include "../support/sweep_checks.hpp"

namespace taut_test::sweep_forces_test {

namespace {

template <class System>
void check_all_steppers(const System& system, const typename System::State& start) {
    check_equals_plain_path<taut::SymplecticEuler>(system, start);
    check_equals_plain_path<taut::ExplicitEuler>(system, start);
    check_equals_plain_path<taut::VelocityVerlet>(system, start);
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

TEMPLATE_TEST_CASE("sweep: wind acts as on the plain path", "[integrator][slow]", float, double) {
    Random random(91);
    for (const int triangles : {1, 2, 5, 300, 2600}) {
        CAPTURE(triangles);
        auto mesh = irregular<TestType, 3>(random, 2500, triangles == 300);
        auto grid = net<TestType, 3>(random, 47, 53);
        for (auto* system : {&grid, &mesh}) {
            taut::set_wind(*system, draw_wind<TestType>(random, system->size(), triangles));
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
        taut::set_wind(cloth, wind);
        auto start = random_state(random, cloth);
        start.x = cloth.initial_state().x;
        check_all_steppers(cloth, start);
    }
}

/// A chain over many blocks, and triangles that reach further than its springs.
template <class Scalar>
taut::SpringSystem<Scalar, 3> chain_in_wind(Random& random, int particles) {
    taut::SpringSystem<Scalar, 3> chain;
    for (int i = 0; i < particles; ++i) {
        chain.add_particle(random.vector<Scalar, 3>(-1, 1), static_cast<Scalar>(0.02));
        if (i % 5 > 0) {
            chain.add_spring(taut::Spring<Scalar, taut::Hookean>{i - 1, i, {Scalar(2)}, Scalar(1)});
        }
    }
    taut::Wind<Scalar> wind;
    wind.velocity = {3, 2, -4};
    for (int k = 0; k < 40; ++k) {
        const Index a = random.below(particles / 3);
        wind.triangles.push_back({a, a + particles / 3, a + 2 * (particles / 3)});
    }
    wind.triangles.push_back({2046, 2047, 2048});
    taut::set_wind(chain, wind);
    return chain;
}

TEMPLATE_TEST_CASE("sweep: triangles may reach further than springs, over several blocks",
                   "[integrator]", float, double) {
    Random random(96);
    for (const int particles : {2100, 5000, 6300}) {
        auto chain = chain_in_wind<TestType>(random, particles);
        check_all_steppers(chain, random_state(random, chain));
    }
}

TEMPLATE_TEST_CASE("sweep: how steps are divided into calls changes no bit", "[integrator]", float,
                   double) {
    Random random(97);
    auto chain = chain_in_wind<TestType>(random, 6300);
    auto grid = net<TestType, 3>(random, 70, 70);
    taut::set_wind(grid, draw_wind<TestType>(random, grid.size(), 3000));
    auto mesh = irregular<TestType, 3>(random, 4500, false);
    taut::set_wind(mesh, draw_wind<TestType>(random, mesh.size(), 3000));
    for (auto* system : {&chain, &grid, &mesh}) {
        const auto start = random_state(random, *system);
        auto at_once = start;
        auto one_by_one = start;
        taut::SymplecticEuler stepper(*system);
        REQUIRE(stepper.step(at_once, TestType(1e-3), 21));
        for (int i = 0; i < 21; ++i) REQUIRE(stepper.step(one_by_one, TestType(1e-3)));
        CHECK(at_once.x == one_by_one.x);
        CHECK(at_once.v == one_by_one.v);
    }
}

TEMPLATE_TEST_CASE("sweep: what is finite never falls back on the plain path", "[integrator]",
                   float, double) {
    Random random(98);
    for (const int triangles : {1, 2, 3, 700}) {
        auto chain = chain_in_wind<TestType>(random, 2100);
        auto grid = net<TestType, 3>(random, 20, 20);
        auto mesh = irregular<TestType, 3>(random, 600, false);
        for (auto* system : {&chain, &grid, &mesh}) {
            taut::set_wind(*system, draw_wind<TestType>(random, system->size(), triangles));
            Index calls = 0;
            system->set_external_force([&calls](const auto&, auto&) { ++calls; });
            auto state = random_state(random, *system);
            REQUIRE(taut::SymplecticEuler(*system).step(state, TestType(1e-3), 9));
            CHECK(calls == 9);
        }
    }
}

TEST_CASE("wind: guarded and implicit steps take it as a force of the whole state",
          "[integrator]") {
    auto blown = taut::hanging_cloth<double>({12, 12});
    auto pushed = blown;
    taut::Wind<double> wind;
    wind.velocity = {4, 3, 2};
    wind.triangles = taut::cloth_triangles({12, 12});
    taut::set_wind(blown, wind);
    pushed.set_external_force([wind](const auto& state, auto& f) {
        taut::network_detail::add_wind(taut::network_detail::Air<double>(wind), wind.triangles,
                                       state.x, state.v, f);
    });
    const auto check = [](const auto& a, const auto& b) {
        CHECK(distance(a.v, b.v) <= 1e-9 * largest(b.v));
    };
    auto a = blown.initial_state();
    auto b = a;
    taut::Guarded<taut::SymplecticEuler<taut::SpringSystem<double, 3>>> first(blown);
    taut::Guarded<taut::SymplecticEuler<taut::SpringSystem<double, 3>>> second(pushed);
    for (int frame = 0; frame < 5; ++frame) {
        const auto ours = first.advance(a, 1.0 / 60);
        const auto theirs = second.advance(b, 1.0 / 60);
        REQUIRE(ours);
        CHECK(ours.substeps == theirs.substeps);
        CHECK(std::abs(ours.work - theirs.work) <= 1e-9 * std::abs(theirs.work));
        check(a, b);
    }
    DirectEuler implicit(blown);
    DirectEuler other(pushed);
    REQUIRE(implicit.step(a, 1.0 / 60, 3));
    REQUIRE(other.step(b, 1.0 / 60, 3));
    check(a, b);
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
        taut::set_wind(system, draw_wind<double>(random, system.size(), 500));
        check();
        taut::set_wind_velocity(system, {-4, 5, 6});
        check();
        taut::set_wind(system, draw_wind<double>(random, system.size(), 90));
        check();
        system.add_spring(3, 2100, 50.0);
        check();
        taut::set_wind(system, taut::Wind<double>());
        check();
        CHECK_FALSE(system.has_external_force());
    }
}

TEMPLATE_TEST_CASE("sweep: forces of the state and constant ones act as on the plain path",
                   "[integrator][slow]", (Case<float, 2>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(94);
    auto grid = net<Scalar, TestType::Dim>(random, 50, 50);
    auto mesh = irregular<Scalar, TestType::Dim>(random, 2500, true);
    for (auto* system : {&grid, &mesh}) {
        const auto start = random_state(random, *system);
        for (int k = 0; k < 300; ++k) {
            system->set_constant_force(random.below(system->size()),
                                       random.vector<Scalar, TestType::Dim>(-9, 9));
        }
        check_all_steppers(*system, start);
        system->set_external_force([](const auto& state, auto& f) { f -= state.v; });
        check_all_steppers(*system, start);
        // A particle that came after the constant forces has none.
        system->add_particle(random.vector<Scalar, TestType::Dim>(-1, 1), Scalar(1));
        check_all_steppers(*system, random_state(random, *system));
    }
}

TEST_CASE("sweep: a force that throws leaves nothing behind", "[integrator]") {
    Random random(95);
    for (const bool stars : {false, true}) {
        auto system =
            stars ? irregular<double, 3>(random, 2300, false) : net<double, 3>(random, 48, 48);
        taut::SymplecticEuler stepper(system);
        const auto start = random_state(random, system);
        auto state = start;
        int calls = 0;
        system.set_external_force([&calls](const auto&, auto&) {
            if (++calls == 2) throw std::runtime_error("enough");
        });
        CHECK_THROWS_AS(static_cast<void>(stepper.step(state, 1e-3, 2)), std::runtime_error);
        CHECK(state.x == start.x);
        system.set_external_force({});
        REQUIRE(stepper.step(state, 1e-3, 2));
        auto expected = start;
        plain_steps<taut::Method::symplectic_euler>(system, expected, 1e-3, 2);
        CHECK(distance(state.v, expected.v) <= 1e-12 * largest(expected.v));
    }
}

}  // namespace taut_test::sweep_forces_test
