// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/network/state_view.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/proof/energy_limit.hpp>
#include <taut/wind/wind.hpp>
#include <taut/network/tension_only.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/message.hpp"
#include "../support/sweep_checks.hpp"
#include "../support/tolerance.hpp"

// The kernels of the energy-stable step, and what it does to whole scenes.

namespace taut_test::energy_stable_sweep_test {

using taut::EnergyStableEuler;
using taut::Hookean;
using taut::SpringSystem;

namespace {

template <class System>
void plain_steps_ahead(const System& system, typename System::State& state,
                       typename System::Scalar h, int count) {
    typename System::Force f;
    for (int i = 0; i < count; ++i) {
        system.force_ahead(state, h, f);
        state.v.array() += h * (f.array().rowwise() * system.inverse_mass().transpose().array());
        state.x += h * state.v;
        state.time += h;
    }
}

/// Some steps, more than a wave, are those of the plain path, to rounding.
template <class System>
void check_equals_plain(const System& system, const typename System::State& start) {
    using Scalar = typename System::Scalar;
    EnergyStableEuler<System> stepper(system);
    auto state = start;
    auto expected = start;
    const auto h = static_cast<Scalar>(0.001);
    REQUIRE(stepper.step(state, h));
    REQUIRE(stepper.step(state, h, 11));
    plain_steps_ahead(system, expected, h, 12);
    const double scale = largest(expected.v) + largest(expected.x);
    CHECK(distance(state.x, expected.x) <= Tolerance<Scalar>::rounding * scale);
    CHECK(distance(state.v, expected.v) <= Tolerance<Scalar>::rounding * scale);
    CHECK(distance(state.v, start.v) > 1e-4);
    CHECK(state.time == expected.time);
}

template <class System>
void set_all_outside(System& system) {
    using Scalar = typename System::Scalar;
    system.set_external_force([](const auto& state, auto& f) {
        f += (Scalar(1) + 100 * state.time) * state.x - Scalar(0.5) * state.v;
    });
    if constexpr (System::Dim == 3) {
        taut::Wind<Scalar> wind;
        wind.velocity = {1, 2, 3};
        for (Index i = 0; i + 52 < system.size(); i += 3)
            wind.triangles.push_back(
                {static_cast<int>(i), static_cast<int>(i + 1), static_cast<int>(i + 51)});
        set_wind(system, wind);
    }
}

/// Says that its tension never falls, which is not so.
struct Untrue : Glue {
    static constexpr bool monotone = true;
};

}  // namespace

TEMPLATE_TEST_CASE("energy_stable_euler: runs, batches and stars are the plain path",
                   "[integrator]", (Case<float, 2>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(4250);
    for (const bool damped : {false, true}) {
        RandomOptions options;
        options.particles = 300;
        options.springs = 900;
        options.dampers = options.rayleigh = damped;
        const auto scattered = random_system<Scalar, Dim>(random, options);
        auto grid = net<Scalar, Dim>(random, 50, 50);
        auto mesh = irregular<Scalar, Dim>(random, 2600, damped);
        if (damped) grid.set_rayleigh({0, 0.01});
        for (auto* system : {&grid, &mesh}) {
            check_equals_plain(*system, random_state(random, *system));
            set_all_outside(*system);
            check_equals_plain(*system, random_state(random, *system));
        }
        check_equals_plain(scattered, random_state(random, scattered));
    }
}

TEMPLATE_TEST_CASE("energy_stable_euler: so are laws that only pull, or of two kinds",
                   "[integrator]", (Strings<float, 3>), (Strings<double, 2>), (Mixed<double, 3>),
                   (Mixed<float, 2>)) {
    using System = TestType;
    Random random(4251);
    for (const bool damped : {false, true}) {
        RandomOptions options;
        options.particles = 400;
        options.springs = 700;
        options.dampers = options.rayleigh = damped;
        auto system = random_like<System>(random, options);
        check_equals_plain(system, random_state(random, system));
    }
}

TEMPLATE_TEST_CASE(
    "energy_stable_euler: the same bits in one call or in many, of a State or a view",
    "[integrator]", float, double) {
    using System = Mixed<TestType, 3>;
    Random random(4252);
    for (const bool dampers : {false, true}) {
        RandomOptions options;
        options.dampers = dampers;
        const auto system = random_like<System>(random, options);
        const auto start = random_state(random, system);
        const auto h = static_cast<TestType>(1e-3);
        auto together = start;
        auto apart = start;
        EnergyStableEuler<System> stepper(system);
        REQUIRE(stepper.step(together, h, 25));
        for (int i = 0; i < 25; ++i) REQUIRE(stepper.step(apart, h));
        CHECK(same_bits(together, apart));
        std::vector<TestType> x(static_cast<std::size_t>(3 * system.size())), v = x;
        taut::StateView<TestType, 3> view(x.data(), v.data(), system.size(), 3);
        view.copy_from(start);
        EnergyStableEuler<System> other(system);
        REQUIRE(other.step(view, h, 25));
        for (Index i = 0; i < system.size(); ++i) {
            for (Index d = 0; d < 3; ++d) {
                CHECK(x[static_cast<std::size_t>(3 * i + d)] == together.x(d, i));
                CHECK(v[static_cast<std::size_t>(3 * i + d)] == together.v(d, i));
            }
        }
    }
}

TEMPLATE_TEST_CASE("energy_stable_euler: without pins, gravity and drag momentum is kept",
                   "[integrator]", (Strings<double, 2>), (Mixed<double, 3>)) {
    using System = TestType;
    Random random(4253);
    for (const bool damped : {false, true}) {
        RandomOptions options;
        options.pinned = 0;
        options.gravity = false;
        options.dampers = damped;
        auto system = random_like<System>(random, options);
        if (damped) system.set_rayleigh({0, 0.001});
        auto state = random_state(random, system);
        const auto momentum = [&] {
            Eigen::VectorXd sum = Eigen::VectorXd::Zero(System::Dim);
            for (Index i = 0; i < system.size(); ++i) sum += system.mass(i) * state.v.col(i);
            return sum;
        };
        const Eigen::VectorXd before = momentum();
        EnergyStableEuler<System> stepper(system);
        REQUIRE(stepper.step(state, taut::energy_limit(system).certified, 500));
        CHECK((momentum() - before).norm() <= 1e-12 * static_cast<double>(system.size()));
    }
}

TEST_CASE("energy_stable_euler: a hanging cloth loses little in half a second, and never gains",
          "[integrator]") {
    const auto check = [](const auto& cloth) {
        using System = std::decay_t<decltype(cloth)>;
        const double h = taut::energy_limit(cloth).certified;
        EnergyStableEuler<System> stepper(cloth);
        auto state = cloth.initial_state();
        const double start = cloth.energy(state);
        double energy = start, largest_kinetic = 0;
        for (double time = 0; time < 0.5; time += h) {
            REQUIRE(stepper.step(state, h));
            const double next = cloth.energy(state);
            CHECK(next <= energy + 1e-12);
            energy = next;
            largest_kinetic = std::max(largest_kinetic, cloth.kinetic_energy(state));
        }
        CHECK(start - energy <= 0.02 * largest_kinetic);
    };
    const auto cloth = taut::hanging_cloth<double>({32, 32});
    check(cloth);
    check(taut::with_law<TensionOnly>(cloth));
}

TEST_CASE("energy_stable_euler: scenes without springs, wrong steps, states that are not finite",
          "[integrator][bad_input]") {
    using System = SpringSystem<double, 2>;
    System system;
    EnergyStableEuler<System> stepper(system);
    auto state = system.initial_state();
    CHECK(stepper.step(state, 0.1));
    system.add_particle({0, 0}, 1);
    system.set_gravity({0, -10});
    state = system.initial_state();
    REQUIRE(stepper.step(state, 0.5, 2));
    CHECK(state.v(1, 0) == -10);
    CHECK(state.x(1, 0) == -7.5);
    for (const double h : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        CHECK(stepper.step(state, h).status == taut::Status::invalid_step);
    CHECK_THROWS_AS(EnergyStableEuler<System>(system, {0}), std::invalid_argument);
    // A spring of no length that would push has no direction, and does not.
    system.add_particle({0, 0}, 1);
    system.add_spring(taut::Spring<double, Hookean>{0, 1, {100}, 1});
    system.set_gravity({0, 0});
    state = system.initial_state();
    REQUIRE(stepper.step(state, 0.01, 3));
    CHECK(state.v.isZero(0));
    auto broken = state;
    broken.v(0, 0) = std::nan("");
    CHECK_FALSE(stepper.step(broken, 0.01));
    CHECK(broken.x == state.x);
    // Far above every limit it overflows; the state is as before.
    state.v(0, 0) = 1;
    const auto before = state;
    CHECK_FALSE(stepper.step(state, 1e6, 1000));
    CHECK(same_bits(state, before));
}

#ifndef NDEBUG
TEST_CASE("energy_stable_euler: a law whose tension falls although it says no is named",
          "[integrator][bad_input]") {
    SpringSystem<double, 2, Untrue> system;
    system.add_particle({0, 0}, 1);
    system.add_particle({1, 0}, 1);
    const auto message = message_of([&] { system.add_spring<Untrue>(0, 1, {100, 0.5}); });
    CHECK(missing(message, {"Untrue", "never falls", "T' is -"}) == "");
}
#endif

}  // namespace taut_test::energy_stable_sweep_test
