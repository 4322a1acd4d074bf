// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/explicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/network/tension_only.hpp>

#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/sweep_checks.hpp"
#include "../support/tolerance.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace taut_test::sweep_test {

namespace {

/// TensionOnly in arithmetic that registers can do, too.
struct Slack : TensionOnly {
    static constexpr bool vectorizable = true;

    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        using std::max;
        return p.stiffness * max(l - L, Scalar(0));
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        using std::max;
        using std::min;
        // 1 where l > L: any excess is far more than the square of a rounding error.
        const Scalar excess = max(l - L, Scalar(0));
        return p.stiffness * min(excess * Scalar(1e30f), Scalar(1));
    }
};

template <class Scalar>
Slack::Parameters<Scalar> draw_parameters(Random& random, Slack) {
    return {static_cast<Scalar>(random.uniform(20, 200))};
}

/// Where the C library can: all bits of what is allocated from now on are 1.
void fill_new_memory_with_nan([[maybe_unused]] bool yes) {
#ifdef __GLIBC__
    mallopt(M_PERTURB, yes ? 0x100 : 0);  // the byte's complement
#endif
}

/// Depends on x, v, time and index.
template <class System>
void set_some_external_force(System& system) {
    system.set_external_force([](const auto& state, auto& f) {
        using Scalar = typename System::Scalar;
        for (Index i = 0; i < state.x.cols(); ++i) {
            f.col(i) +=
                (Scalar(1) + 100 * state.time) * state.x.col(i) - Scalar(0.5) * state.v.col(i);
            f(0, i) += static_cast<Scalar>(i % 7);
        }
    });
}

}  // namespace

TEMPLATE_TEST_CASE("sweep: a law without springs, or no spring at all", "[integrator]", float,
                   double) {
    Random random(57);
    for (const bool springs : {false, true}) {
        taut::SpringSystem<TestType, 3, taut::Hookean, TensionOnly> system;
        for (int i = 0; i < 9; ++i) {
            system.add_particle(random.vector<TestType, 3>(-1, 1), TestType(1));
        }
        system.set_gravity({0, 0, -10});
        for (Index i = 0; springs && i < 9; ++i) {
            system.template add_spring<TensionOnly>(
                {i, (4 * i + 1) % 9 == i ? (i + 2) % 9 : (4 * i + 1) % 9, {80}, TestType(0.1)});
        }
        check_equals_plain_path<taut::SymplecticEuler>(system, random_state(random, system));
        check_equals_plain_path<taut::VelocityVerlet>(system, random_state(random, system));
    }
}

TEMPLATE_TEST_CASE("sweep: a scene without order is stepped as by the plain path", "[integrator]",
                   (Case<float, 2>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(41);
    for (const bool damped : {false, true}) {
        RandomOptions options;
        options.particles = 300;
        options.springs = 900;
        options.dampers = damped;
        options.rayleigh = damped;
        options.pinned = damped ? 7 : 0;
        const auto system = random_system<Scalar, TestType::Dim>(random, options);
        check_equals_plain_path<taut::SymplecticEuler>(system, random_state(random, system));
        check_equals_plain_path<taut::ExplicitEuler>(system, random_state(random, system));
    }
}

TEMPLATE_TEST_CASE("sweep: irregular meshes over several blocks are stepped as by the plain path",
                   "[integrator]", (Case<float, 2>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(48);
    for (const bool damped : {false, true}) {
        const auto system = irregular<Scalar, TestType::Dim>(random, 2600, damped);
        const auto start = random_state(random, system);
        check_equals_plain_path<taut::SymplecticEuler>(system, start);
        check_equals_plain_path<taut::ExplicitEuler>(system, start);
        check_equals_plain_path<taut::VelocityVerlet>(system, start);
    }
}

TEMPLATE_TEST_CASE("sweep: an external force acts as on the plain path", "[integrator]",
                   (Case<float, 2>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(55);
    auto grid = net<Scalar, TestType::Dim>(random, 50, 50);
    auto mesh = irregular<Scalar, TestType::Dim>(random, 2500, true);
    for (auto* system : {&grid, &mesh}) {
        set_some_external_force(*system);
        const auto start = random_state(random, *system);
        check_equals_plain_path<taut::SymplecticEuler>(*system, start);
        check_equals_plain_path<taut::ExplicitEuler>(*system, start);
        check_equals_plain_path<taut::VelocityVerlet>(*system, start);
    }
}

TEST_CASE("sweep: an external force is asked once a step, whatever memory held before",
          "[integrator]") {
    for (const Index columns : {9, 31, 50}) {
        auto cloth = taut::hanging_cloth<double>({columns, columns});
        int calls = 0;
        cloth.set_external_force([&](const auto&, auto& f) {
            ++calls;
            f.array() += 1e-3;
        });
        auto state = cloth.initial_state();
        taut::SymplecticEuler stepper(cloth);
        fill_new_memory_with_nan(true);
        const auto report = stepper.step(state, 1e-5, 5);
        fill_new_memory_with_nan(false);
        CHECK(report);
        CHECK(calls == 5);
    }
}

TEST_CASE("sweep: velocity Verlet goes on from the last state after a force that throws",
          "[integrator]") {
    Random random(58);
    auto system = net<double, 3>(random, 8, 8);
    int calls_left = 1000;
    system.set_external_force([&](const auto& state, auto& f) {
        if (calls_left-- == 0) throw std::runtime_error("no force");
        f += state.x;
    });
    for (const int steps : {1, 3}) {
        for (int until = 0; until <= steps; ++until) {
            const auto start = random_state(random, system);
            taut::VelocityVerlet stepper(system);
            auto state = start;
            REQUIRE(stepper.step(state, 0.001, 2));
            const auto before = state;
            calls_left = until;
            if (until < steps) {
                CHECK_THROWS_AS(stepper.step(state, 0.001, steps), std::runtime_error);
                CHECK(same_bits(state, before));
            }
            calls_left = 1000;
            REQUIRE(stepper.step(state, 0.001, steps));
            auto expected = start;
            plain_steps<taut::Method::velocity_verlet>(system, expected, 0.001, 2 + steps);
            CHECK(distance(state.x, expected.x) <= Tolerance<double>::rounding);
            CHECK(distance(state.v, expected.v) <= Tolerance<double>::rounding);
        }
    }
}

TEST_CASE("sweep: an external force never sees a state that is not finite", "[integrator]") {
    Random random(56);
    for (const double h : {1.0, 1e300}) {
        auto system = net<double, 2>(random, 20, 20);
        bool finite = true;
        system.set_external_force([&](const auto& state, auto& f) {
            finite = finite && state.finite();
            f += state.x;
        });
        auto state = random_state(random, system);
        taut::SymplecticEuler symplectic(system);
        CHECK(symplectic.step(state, h, 5000).status == taut::Status::diverged);
        taut::VelocityVerlet verlet(system);
        CHECK(verlet.step(state, h, 5000).status == taut::Status::diverged);
        CHECK(finite);
    }
}

TEST_CASE("sweep: velocity Verlet's steps of grids, and of systems of registers' laws and others",
          "[integrator]") {
    Random random(49);
    auto grid = net<double, 3>(random, 90, 30);
    grid.pin(0);
    grid.set_rayleigh({0.25, 0.0078125});
    check_equals_plain_path<taut::VelocityVerlet>(grid, random_state(random, grid));
    RandomOptions options;
    options.particles = 60;
    options.springs = 150;
    const auto mixed =
        random_system<double, 3, taut::Hookean, Glue, TensionOnly, Slack>(random, options);
    check_equals_plain_path<taut::VelocityVerlet>(mixed, random_state(random, mixed));
}

TEMPLATE_TEST_CASE("sweep: graphs of odd degrees are stepped as by the plain path", "[integrator]",
                   float, double) {
    Random random(50);
    const auto check = [&](int particles, const auto& add_springs) {
        taut::SpringSystem<TestType, 3> system;
        for (int i = 0; i < particles; ++i) {
            system.add_particle(random.vector<TestType, 3>(-1, 1),
                                static_cast<TestType>(random.uniform(0.5, 2)));
        }
        add_springs(system);
        check_equals_plain_path<taut::SymplecticEuler>(system, random_state(random, system));
    };
    const auto stiffness = static_cast<TestType>(5);
    check(10001, [&](auto& star) {
        for (Index i = 1; i <= 10000; ++i) star.add_spring(i, 0, stiffness);
    });
    check(9001, [&](auto& all_through_the_last) {
        for (Index i = 0; i < 9000; ++i) {
            all_through_the_last.add_spring(9000, (i * 7919) % 9000, stiffness);
        }
    });
    check(5000, [&](auto& chain) {
        for (Index i = 1; i < 5000; ++i)
            chain.add_spring((i * 7) % 5000, (i * 7 - 7) % 5000, stiffness);
    });
    check(2, [&](auto& pair) {
        for (int i = 0; i < 5; ++i) pair.add_spring(0, 1, stiffness + static_cast<TestType>(i));
    });
}

TEST_CASE("sweep: a spring added between steps is felt in the next", "[integrator]") {
    Random random(51);
    auto system = irregular<double, 3>(random, 300, false);
    auto state = random_state(random, system);
    auto expected = state;
    taut::SymplecticEuler stepper(system);
    for (Index i = 0; i < 30; ++i) {
        const Index a = (7 * i + 3) % 300;
        const Index b = (a + 1 + 5 * i) % 300;
        system.add_spring(a, b, 100 + static_cast<double>(i));
        REQUIRE(stepper.step(state, 0.001));
        plain_steps<taut::Method::symplectic_euler>(system, expected, 0.001, 1);
    }
    CHECK(distance(state.x, expected.x) <= Tolerance<double>::accumulated);
    CHECK(distance(state.v, expected.v) <= Tolerance<double>::accumulated);
}

TEST_CASE("sweep: a plan that changes from stars to runs leaves no force behind", "[integrator]") {
    Random random(54);
    auto system = net<double, 3>(random, 90, 30);
    const Index springs = system.spring_count();
    for (Index i = 0; i < 2 * springs; ++i) {
        const Index a = i * 37 % system.size();
        system.add_spring(a, (a + 1 + i * 101 % (system.size() - 1)) % system.size(), 20.0);
    }
    const auto start = random_state(random, system);
    taut::SymplecticEuler used(system);
    auto state = start;
    REQUIRE(used.step(state, 0.001, 3));
    system.remove_springs([&](Index s) { return s >= springs; });
    taut::SymplecticEuler fresh(system);
    state = start;
    auto expected = start;
    REQUIRE(used.step(state, 0.001, 3));
    REQUIRE(fresh.step(expected, 0.001, 3));
    CHECK(same_bits(state, expected));
}

TEMPLATE_TEST_CASE("sweep: grids of any width are stepped as by the plain path", "[integrator]",
                   float, double) {
    Random random(42);
    for (const Index columns : {17, 30, 64}) {
        for (const bool damped : {false, true}) {
            auto system = net<TestType, 3>(random, 90, columns);  // 64: beyond one block
            if (damped) {
                system.set_rayleigh({0.25, 0.0078125});
                system.pin(columns - 1);
                system.add_spring(taut::Spring<TestType, taut::Hookean>{
                    0, 89 * columns, {100}, TestType(0.5), TestType(2)});
            }
            system.set_gravity({0, -10, 3});
            check_equals_plain_path<taut::SymplecticEuler>(system, random_state(random, system));
        }
    }
}

TEMPLATE_TEST_CASE("sweep: a lone damper along a grid acts in every block", "[integrator]", float,
                   double) {
    Random random(43);
    auto system = net<TestType, 2>(random, 80, 60);
    for (Index i = 0; i + 2000 < system.size(); i += 7) {
        system.add_spring(taut::Spring<TestType, taut::Hookean>{
            i, i + 2000, {50}, TestType(0.5), static_cast<TestType>(random.uniform(0.1, 2))});
    }
    check_equals_plain_path<taut::SymplecticEuler>(system, random_state(random, system));
}

TEMPLATE_TEST_CASE("sweep: every law, in registers or one by one", "[integrator]", float, double) {
    Random random(44);
    RandomOptions options;
    options.particles = 60;
    options.springs = 150;
    for (const bool damped : {false, true}) {
        options.dampers = damped;
        options.rayleigh = damped;
        auto system =
            random_system<TestType, 3, taut::Hookean, Glue, TensionOnly, Slack>(random, options);
        // Runs of both kinds of law.
        for (Index i = 0; i + 3 < 60; ++i) {
            system.template add_spring<Glue>({i, i + 3, {60, TestType(0.5)}, TestType(0.7)});
            system.template add_spring<Slack>({i, i + 2, {80}, TestType(0.7)});
        }
        check_equals_plain_path<taut::SymplecticEuler>(system, random_state(random, system));
    }
}

TEMPLATE_TEST_CASE("sweep: springs of no length are the plain path's", "[integrator]", float,
                   double) {
    Random random(45);
    for (const bool rest : {false, true}) {
        auto system = net<TestType, 3>(random, 40, 20);
        for (Index i = 0; i + 5 < system.size(); i += 5) {
            system.add_spring(taut::Spring<TestType, taut::Hookean>{
                i, i + 5, {50}, TestType(rest ? 0.5 : 0), TestType(1)});
        }
        system.set_rayleigh({0, 0.0078125});
        auto state = random_state(random, system);
        for (Index i = 0; i < system.size(); ++i) {
            if (i % 3 != 0) state.x.col(i) = state.x.col(i / 3 * 3);
        }
        Random later(46);
        state.v = later.points<TestType, 3>(system.size(), -1, 1);
        taut::SymplecticEuler fast_stepper(system);
        auto expected = state;
        const auto start = state;
        REQUIRE(fast_stepper.step(state, TestType(0.001)));
        plain_steps<taut::Method::symplectic_euler>(system, expected, TestType(0.001), 1);
        CHECK(distance(state.v, expected.v) <= Tolerance<TestType>::rounding);
        CHECK(distance(state.v, start.v) > 1e-3);
    }
}

TEST_CASE("sweep: divergence late in a long call names the plain path's step and particle",
          "[integrator]") {
    Random random(47);
    auto system = net<double, 2>(random, 30, 30);
    auto start = random_state(random, system);
    taut::SymplecticEuler stepper(system);
    auto state = start;
    const auto report = stepper.step(state, 1.0, 5000);
    auto expected = start;
    int steps = 0;
    while (expected.finite()) {
        plain_steps<taut::Method::symplectic_euler>(system, expected, 1.0, 1);
        ++steps;
    }
    CHECK(report.status == taut::Status::diverged);
    CHECK(report.iterations == steps - 1);
    CHECK(report.where == expected.first_not_finite());
    CHECK(same_bits(state, start));
}

TEST_CASE("sweep: a number of threads below one is refused", "[integrator][bad_input]") {
    const auto cloth = taut::hanging_cloth<double>({3, 3});
    CHECK_THROWS_WITH(taut::SymplecticEuler(cloth, {0}),
                      ContainsSubstring("threads is 0; it must be >= 1"));
}

}  // namespace taut_test::sweep_test
