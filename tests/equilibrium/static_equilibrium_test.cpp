// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <taut/lattice/chain.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::static_equilibrium_test {

using taut::ChainEnds;
using taut::Report;
using taut::static_equilibrium;
using taut::Status;

namespace {

/// max |force| on the free particles, and the sum of forces on the pinned ones.
template <class System>
double free_force(const System& system, const typename System::State& state) {
    typename System::Force f;
    system.force(state, f);
    double size = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) size = std::max(size, largest(f.col(i)));
    }
    return size;
}

template <class System>
typename System::Vector pin_force(const System& system, const typename System::State& state) {
    typename System::Force f;
    system.force(state, f);
    typename System::Vector sum = System::Vector::Zero();
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) sum += f.col(i);
    }
    return sum;
}

}  // namespace

TEMPLATE_TEST_CASE(
    "static_equilibrium: a hanging chain has no force left, and its pins bear its weight",
    "[equilibrium]", (Case<float, 2>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    auto system = taut::chain<Scalar, Dim>({20, ChainEnds::fixed_fixed, 0.05, 500, 0.1});
    typename decltype(system)::Vector gravity = decltype(system)::Vector::Zero();
    gravity[1] = Scalar(-9.81);
    system.set_gravity(gravity);
    auto state = system.initial_state();
    state.v.setOnes();
    state.time = 2;
    taut::EquilibriumOptions options;
    if (sizeof(Scalar) == 4) options.tolerance = 1e-4;
    const Report report = static_equilibrium(system, state, options);
    REQUIRE(report);
    CHECK(report.residual <= options.tolerance);
    CHECK(report.iterations > 0);
    const double weight = 20 * 0.05 * 9.81;
    CHECK(free_force(system, state) <= options.tolerance * weight);
    CHECK(state.v.isZero(0));
    CHECK(state.time == 2);
    // What the pins bear includes the weight of the two pinned particles themselves.
    CHECK(distance(pin_force(system, state), 22 * Scalar(0.05) * gravity) <=
          20 * options.tolerance * weight);
    // It hangs, symmetric, and every spring has the same horizontal tension.
    const Scalar horizontal = [&] {
        typename decltype(system)::Force f;
        system.force(state, f);
        return f(0, 20);
    }();
    CHECK(horizontal > 0);
    const auto& set = system.springs();
    for (std::size_t s = 0; s < set.a.size(); ++s) {
        const auto t = set.tangent(s, state.x);
        CHECK(std::abs(t.transverse * (state.x(0, t.b) - state.x(0, t.a)) - horizontal) <=
              20 * options.tolerance * weight);
    }
    for (int i = 0; i < 10; ++i) {
        CHECK(state.x(1, i) < 0);
        CHECK(std::abs(static_cast<double>(state.x(1, i) - state.x(1, 19 - i))) <
              50 * options.tolerance);
    }
}

TEST_CASE("static_equilibrium: one mass on one spring stretches it by m g / k", "[equilibrium]") {
    taut::SpringSystem<double, 3> system;
    system.add_particle({0, 0, 1}, 2);
    system.add_particle({0.25, 0, 0.5}, 3);
    system.pin(0);
    system.add_spring(taut::Spring<double, taut::Hookean>{0, 1, {600}, 0.5});
    system.set_gravity({0, 0, -10});
    auto state = system.initial_state();
    REQUIRE(static_equilibrium(system, state));
    CHECK(distance(state.x.col(1), Eigen::Vector3d(0, 0, 0.5 - 0.05)) <
          Tolerance<double>::difference);
    CHECK((state.x.col(0) == Eigen::Vector3d(0, 0, 1)));
}

TEST_CASE("static_equilibrium: a hanging cloth, from its flat pose", "[equilibrium]") {
    const auto cloth = taut::hanging_cloth<double>({8, 8});
    auto state = cloth.initial_state();
    REQUIRE(static_equilibrium(cloth, state));
    CHECK(free_force(cloth, state) <= 1e-8 * 0.3 * 9.81);
    CHECK(distance(pin_force(cloth, state), Eigen::Vector3d(0, 0, -0.3 * 9.81)) <
          Tolerance<double>::difference);
    auto again = state;
    const Report report = static_equilibrium(cloth, again);  // already there
    REQUIRE(report);
    CHECK(report.iterations == 0);
    CHECK(same_bits(again, state));
}

TEST_CASE("static_equilibrium: crumpled scenes of several laws find a pose without force",
          "[equilibrium]") {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        Random random(seed);
        const auto system = random_system<double, 3, taut::Hookean, TensionOnly>(random);
        auto state = random_state(random, system);
        const auto before = state;
        const double energy = system.potential_energy(state);
        INFO("seed " << seed);
        REQUIRE(static_equilibrium(system, state));
        CHECK(free_force(system, state) < 1e-6 * free_force(system, before));
        CHECK(system.potential_energy(state) < energy);
        CHECK((state.x.leftCols(2) == before.x.leftCols(2)));  // the pinned ones
    }
}

TEST_CASE("static_equilibrium: metres or millionths of one are the same to it", "[equilibrium]") {
    const auto in_units = [](std::uint32_t seed, double unit) {
        Random random(seed);
        taut::SpringSystem<double, 3> net;
        for (int i = 0; i < 12; ++i) {
            const Eigen::Vector3d x = random.vector<double, 3>(-1, 1);
            net.add_particle(unit * x, random.uniform(0.5, 2));
        }
        for (Index i = 0; i < 12; ++i) {
            for (const Index step : {1, 4}) {
                net.add_spring(
                    taut::Spring<double, taut::Hookean>{i,
                                                        (i + step) % 12,
                                                        {random.uniform(20, 200)},
                                                        unit * random.uniform(0.2, 1.4)});
            }
        }
        net.pin(0);
        net.set_gravity({0, 0, -10 * unit});
        return net;
    };
    for (std::uint32_t seed = 170; seed < 180; ++seed) {
        INFO("seed " << seed);
        const auto net = in_units(seed, 1);
        auto state = net.initial_state();
        const Report report = static_equilibrium(net, state);
        REQUIRE(report);
        for (const double unit : {0x1p-20, 0x1p20}) {  // powers of 2 change no digit
            const auto other = in_units(seed, unit);
            auto pose = other.initial_state();
            CHECK(static_equilibrium(other, pose).iterations == report.iterations);
            CHECK((pose.x == unit * state.x));
        }
    }
}

/// A straight row of `masses` particles between two pins, a metre apart, along the first axis,
/// whose springs have random lengths that add up to `length` times the distance of the pins.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> strut(Random& random, int masses, double length) {
    taut::SpringSystem<Scalar, Dim> system;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    for (int i = 0; i <= masses + 1; ++i)
        system.add_particle(Vector(Scalar(i) * Vector::Unit(0)),
                            static_cast<Scalar>(random.uniform(0.5, 2)));
    system.pin(0);
    system.pin(masses + 1);
    for (int i = 0; i <= masses; ++i) {
        system.add_spring(taut::Spring<Scalar, taut::Hookean>{
            i, i + 1, {static_cast<Scalar>(random.uniform(50, 500))}, static_cast<Scalar>(length)});
    }
    return system;
}

TEMPLATE_TEST_CASE(
    "static_equilibrium: a strut that is compressed is a saddle, one that is pulled or slack is "
    "none",
    "[equilibrium]", (Case<float, 1>), (Case<double, 1>), (Case<float, 2>), (Case<double, 2>),
    (Case<float, 3>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    taut::EquilibriumOptions options;
    if (sizeof(Scalar) == 4) options.tolerance = 1e-5;
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        Random random(seed);
        const int masses = 1 + static_cast<int>(random.below(30));
        const double strain = std::pow(10, random.uniform(-2.5, -0.5));
        CAPTURE(seed, masses, strain);
        for (const double length : {1 - strain, 1.0, 1 + strain}) {
            const auto system = strut<Scalar, Dim>(random, masses, length);
            auto state = system.initial_state();
            state.x(0, 1) += Scalar(0.1) * static_cast<Scalar>(masses % 2);  // along the row
            if (length == 1 && Dim > 1) state.x(0, 1) = 1;  // slack: nothing to find
            const auto before = state;
            const Report report = static_equilibrium(system, state, options);
            CAPTURE(length, report.residual);
            if (Dim == 1 || length <= 1) {
                CHECK(report.status == Status::ok);
                continue;
            }
            CHECK(report.status == Status::saddle);
            CHECK(report.residual < 1e-3);  // of float, what rounding leaves
            CHECK(same_bits(state, before));
            // Disturbed, it buckles: the pose that is found has less energy, and is stable.
            for (int i = 1; i <= masses; ++i) {
                state.x.col(i) += random.vector<Scalar, Dim>(-0.02, 0.02);
            }
            const double energy = static_cast<double>(system.potential_energy(state));
            const Report buckled = static_equilibrium(system, state, options);
            CHECK(buckled.status == Status::ok);
            CHECK(static_cast<double>(system.potential_energy(state)) < 0.5 * energy);
        }
    }
}

TEST_CASE("static_equilibrium: an external force is balanced", "[equilibrium]") {
    auto system = taut::chain<double, 2>({3, ChainEnds::fixed_fixed, 1, 100, 0.5});
    system.set_external_force([](const auto&, auto& f) { f.row(1).leftCols(3).array() += 20; });
    auto state = system.initial_state();
    REQUIRE(static_equilibrium(system, state));
    CHECK(free_force(system, state) < 1e-6);
    CHECK(state.x(1, 1) > 0);
    CHECK(distance(pin_force(system, state), Eigen::Vector2d(0, 60)) < 1e-6);
}

TEST_CASE(
    "static_equilibrium: not_converged leaves the state: it falls, it may not go on, or no step "
    "lowers anything",
    "[equilibrium]") {
    Random random(1);
    const auto check = [&](const auto& system, int most, int expected) {
        auto state = random_state(random, system);
        const auto before = state;
        taut::EquilibriumOptions options;
        if (most >= 0) options.max_iterations = most;
        const Report report = static_equilibrium(system, state, options);
        CHECK(report.status == Status::not_converged);
        if (expected >= 0) CHECK(report.iterations == expected);
        CHECK(report.residual > 0.01);
        CHECK(same_bits(state, before));
    };
    auto falling = taut::chain<double, 3>({5, ChainEnds::free_free, 1, 100, 0.5});
    falling.set_gravity({0, 0, -9.81});
    check(falling, -1, taut::EquilibriumOptions{}.max_iterations);
    const auto cloth = taut::hanging_cloth<double>({5, 5});
    check(cloth, 0, 0);
    check(cloth, 1, 1);
    // A force that turns round whenever it is asked for.
    auto pushed = taut::chain<double, 3>({3, ChainEnds::fixed_fixed, 1, 100, 0.5});
    int asked = 0;
    pushed.set_external_force(
        [&](const auto&, auto& f) { f.row(1).array() += asked++ % 2 == 0 ? 1e4 : -1e4; });
    check(pushed, -1, -1);
}

TEST_CASE("static_equilibrium: bad input is reported and nothing is touched",
          "[equilibrium][bad_input]") {
    const auto cloth = taut::hanging_cloth<double>({4, 4});
    auto state = cloth.initial_state();
    state.x.conservativeResize(3, 15);
    CHECK(static_equilibrium(cloth, state).status == Status::invalid_state);
    CHECK(state.x.cols() == 15);
    state = cloth.initial_state();
    state.v(2, 7) = std::numeric_limits<double>::quiet_NaN();
    const Report report = static_equilibrium(cloth, state);
    CHECK(report.status == Status::invalid_state);
    CHECK(report.where == 7);
    CHECK(std::isnan(state.v(2, 7)));
    // A force that is not finite is no equilibrium.
    auto pushed = cloth;
    pushed.set_external_force(
        [](const auto&, auto& f) { f(1, 5) = std::numeric_limits<double>::quiet_NaN(); });
    state = cloth.initial_state();
    CHECK_FALSE(static_equilibrium(pushed, state));
    CHECK(same_bits(state, cloth.initial_state()));
}

TEST_CASE("static_equilibrium: with everything pinned, or no particles, there is nothing to find",
          "[equilibrium]") {
    const taut::SpringSystem<double, 2> empty;
    auto nothing = empty.initial_state();
    CHECK(static_equilibrium(empty, nothing));
    Random random(2);
    RandomOptions options;
    options.pinned = options.particles;
    const auto system = random_system<double, 2>(random, options);
    auto state = random_state(random, system);
    const auto x = state.x;
    CHECK(static_equilibrium(system, state));
    CHECK((state.x == x));
}

}  // namespace taut_test::static_equilibrium_test
