// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// Forces and energies. Their derivatives: spring_system_derivatives_test.cpp.
#include <Eigen/Geometry>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::spring_system_force_test {

using taut::Hookean;
using taut::Spring;
using taut::SpringSystem;

TEMPLATE_TEST_CASE("spring_system: no tangent exceeds the law's bound", "[model]",
                   (SpringSystem<double, 2, Hookean, TensionOnly>),
                   (SpringSystem<double, 3, Glue>)) {
    Random random(5);
    const auto system = random_like<TestType>(random);
    for (int trial = 0; trial < 50; ++trial) {
        const auto state = random_state(random, system);
        system.for_each_tangent(state.x, [&](const taut::SpringTangent<double, TestType::Dim>& t) {
            CHECK(std::max(t.axial, t.transverse) <= t.bound * (1 + Tolerance<double>::rounding));
            CHECK(std::min(t.projected().axial, t.projected().transverse) >= 0);
            CHECK_THAT(t.d.norm(), Catch::Matchers::WithinAbs(1, Tolerance<double>::rounding));
        });
    }
}

TEMPLATE_TEST_CASE("spring_system: internal forces sum to zero", "[model]", (Case<float, 1>),
                   (Case<float, 2>), (Case<float, 3>), (Case<double, 1>), (Case<double, 2>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(6);
    RandomOptions options;
    options.dampers = true;
    options.gravity = false;
    auto system = random_system<Scalar, TestType::Dim>(random, options);
    system.set_rayleigh({0, 0.0078125});
    for (int trial = 0; trial < 20; ++trial) {
        const auto state = random_state(random, system);
        taut::Points<Scalar, TestType::Dim> f;
        system.force(state, f);
        CHECK(largest(f.rowwise().sum()) <= Tolerance<Scalar>::rounding * largest(f));
    }
}

TEMPLATE_TEST_CASE("spring_system: springs and axial dampers exert no torque", "[model]", float,
                   double) {
    Random random(7);
    RandomOptions options;
    options.dampers = true;
    options.gravity = false;
    const auto system = random_system<TestType, 3>(random, options);
    for (int trial = 0; trial < 20; ++trial) {
        const auto state = random_state(random, system);
        taut::Points<TestType, 3> f;
        system.force(state, f);
        Eigen::Vector3d torque = Eigen::Vector3d::Zero();
        for (Index i = 0; i < f.cols(); ++i) {
            const Eigen::Vector3d x = state.x.col(i).template cast<double>();
            torque += x.cross(f.col(i).template cast<double>());
        }
        CHECK(largest(torque) <= Tolerance<TestType>::rounding * largest(f));
    }
}

TEMPLATE_TEST_CASE("spring_system: dampers take energy away at any velocity", "[model]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    Random random(8);
    RandomOptions options;
    options.dampers = true;
    options.rayleigh = true;
    const auto system = random_system<double, TestType::Dim>(random, options);
    for (int trial = 0; trial < 50; ++trial) {
        const auto state = random_state(random, system);
        auto still = state;
        still.v.setZero();
        const Eigen::VectorXd drag = flat_force(system, state) - flat_force(system, still);
        CHECK(drag.dot(flat(state.v)) < 0);
    }
}

TEMPLATE_TEST_CASE("spring_system: a spring of zero length pulls with nothing and is k*I stiff",
                   "[model]", (Case<float, 1>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    const Scalar rest_length = GENERATE(Scalar(0), Scalar(1));
    SpringSystem<Scalar, Dim> system;
    const auto place = SpringSystem<Scalar, Dim>::Vector::Ones().eval();
    system.add_particle(place, 1);
    system.add_particle(place, 2);
    system.add_spring(Spring<Scalar, Hookean>{0, 1, {Scalar(50)}, rest_length, Scalar(3)});
    system.set_rayleigh({0, 0.5});
    auto state = system.initial_state();

    CHECK(largest(flat_force(system, state)) == 0);
    CHECK(static_cast<double>(system.potential_energy(state)) ==
          25.0 * static_cast<double>(rest_length));
    const auto linear = system.linearize(state);
    Eigen::MatrixXd expected(2 * Dim, 2 * Dim);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(Dim, Dim);
    expected << 50 * one, -50 * one, -50 * one, 50 * one;
    CHECK(distance(Eigen::MatrixXd(linear.stiffness().template cast<double>()), expected) == 0);

    // Rayleigh damping takes alpha times that tangent; the axial damper has no direction to act in.
    CHECK(distance(Eigen::MatrixXd(linear.damping().template cast<double>()), 0.5 * expected) == 0);
    state.v.col(1).setOnes();
    CHECK(distance(flat_force(system, state), -0.5 * expected * flat(state.v)) == 0);
}

TEST_CASE("spring_system: springs so short that their squared length underflows are finite",
          "[model]") {
    for (const double length : {1e-150, 1e-161, 1e-170, 1e-300}) {
        SpringSystem<double, 3> system;
        system.add_particle({0, 0, 0}, 1);
        system.add_particle({length, 0, 0}, 1);
        system.add_spring(Spring<double, Hookean>{0, 1, {1000}, 1, 2});
        system.set_rayleigh({0, 0.125});
        auto state = system.initial_state();
        state.v(1, 1) = 1;
        CHECK(flat_force(system, state).allFinite());
        CHECK(largest(flat_force(system, state)) <= 2000);
    }
}

TEMPLATE_TEST_CASE("spring_system: duplicate springs add up", "[model]", float, double) {
    SpringSystem<TestType, 2> twice;
    SpringSystem<TestType, 2> once;
    for (auto* system : {&twice, &once}) {
        system->add_particle({TestType(0), TestType(0)}, 1);
        system->add_particle({TestType(1), TestType(2)}, 1);
    }
    twice.add_spring(0, 1, TestType(32), TestType(1));
    twice.add_spring(1, 0, TestType(64), TestType(2));
    once.add_spring(0, 1, TestType(96), TestType(3));
    CHECK(twice.spring_count() == 2);

    Random random(9);
    const auto state = random_state(random, twice);
    const double rounding = 100 * Tolerance<TestType>::rounding;
    CHECK(distance(flat_force(twice, state), flat_force(once, state)) <= rounding);
    const auto a = twice.linearize(state);
    const auto b = once.linearize(state);
    CHECK(distance(Eigen::Matrix<TestType, -1, -1>(a.stiffness()),
                   Eigen::Matrix<TestType, -1, -1>(b.stiffness())) <= rounding);
    CHECK(distance(Eigen::Matrix<TestType, -1, -1>(a.damping()),
                   Eigen::Matrix<TestType, -1, -1>(b.damping())) <= rounding);
    CHECK(a.stiffness().nonZeros() == b.stiffness().nonZeros());
}

TEMPLATE_TEST_CASE("spring_system: float and double agree", "[model]", (Case<float, 1>),
                   (Case<float, 2>), (Case<float, 3>)) {
    constexpr int Dim = TestType::Dim;
    RandomOptions options;
    options.dampers = true;
    options.rayleigh = true;
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        Random first(seed);
        Random second(seed);
        const auto narrow = random_system<float, Dim>(first, options);
        const auto wide = random_system<double, Dim>(second, options);
        const auto narrow_state = random_state(first, narrow);
        const auto wide_state = random_state(second, wide);
        REQUIRE(distance(narrow_state.x, wide_state.x) == 0);
        // A short spring magnifies rounding by rest length over length.
        double shortest = 1;
        wide.for_each_spring([&](Index a, Index b) {
            shortest = std::min(shortest, (wide_state.x.col(a) - wide_state.x.col(b)).norm());
        });
        const double tolerance = Tolerance<float>::rounding / shortest;
        const Eigen::VectorXd f = flat_force(wide, wide_state);
        CHECK(distance(flat_force(narrow, narrow_state), f) < tolerance * largest(f));
        CHECK_THAT(static_cast<double>(narrow.energy(narrow_state)),
                   Catch::Matchers::WithinRel(wide.energy(wide_state), Tolerance<float>::rounding));
        const auto a = narrow.linearize(narrow_state);
        const auto b = wide.linearize(wide_state);
        const Eigen::MatrixXd K(b.stiffness());
        const Eigen::MatrixXd D(b.damping());
        CHECK(distance(Eigen::MatrixXf(a.stiffness()), K) < tolerance * largest(K));
        CHECK(distance(Eigen::MatrixXf(a.damping()), D) < tolerance * largest(D));
    }
}

TEST_CASE("spring_system: kinetic energy is that of the free particles", "[model]") {
    SpringSystem<double, 2> system;
    system.add_particle({0, 0}, 3);
    system.add_particle({1, 0}, 5);
    system.pin(0);
    auto state = system.initial_state();
    state.v << 7, 3, 7, 4;
    CHECK(system.kinetic_energy(state) == 62.5);
    CHECK(system.energy(state) == system.kinetic_energy(state) + system.potential_energy(state));
}

TEST_CASE(
    "spring_system: gravity pulls every particle by its weight, and lifts energy by m g height",
    "[model]") {
    SpringSystem<double, 3> system;
    system.add_particle({0, 0, 0}, 2);
    system.add_particle({0, 0, 4}, 8);
    system.set_gravity({0, 0, -10});
    CHECK((system.gravity() == Eigen::Vector3d(0, 0, -10)));
    const auto state = system.initial_state();
    Eigen::VectorXd expected(6);
    expected << 0, 0, -20, 0, 0, -80;
    CHECK((flat_force(system, state) == expected));
    CHECK(system.potential_energy(state) == 320);
}

TEST_CASE("spring_system: an external force is added after all others, with the state at hand",
          "[model]") {
    Random random(10);
    auto system = random_system<double, 3>(random);
    const auto state = random_state(random, system);
    taut::Points<double, 3> before;
    taut::Points<double, 3> after;
    taut::Points<double, 3> alone;
    system.force(state, before);
    system.external_force(state, alone);
    CHECK((alone == taut::Points<double, 3>::Zero(3, system.size())));

    system.set_external_force([&](const auto& given, auto& f) {
        CHECK(same_bits(given, state));
        f += 2 * given.v + given.x;
    });
    system.force(state, after);
    system.external_force(state, alone);
    CHECK((after == before + (2 * state.v + state.x)));
    CHECK((alone == 2 * state.v + state.x));
    system.set_external_force({});
    system.force(state, after);
    CHECK((after == before));
}

TEMPLATE_TEST_CASE("spring_system: what is not finite in a state is not in the forces either",
                   "[model][bad_input]", float, double) {
    using Limits = std::numeric_limits<TestType>;
    for (const bool damped : {false, true}) {
        taut::SpringSystem<TestType, 2> system;
        for (int i = 0; i < 3; ++i) system.add_particle({TestType(i), TestType(0)}, TestType(1));
        system.add_spring(0, 1, TestType(10), TestType(0.5));
        system.add_spring(taut::Spring<TestType, taut::Hookean>{
            1, 2, {TestType(10)}, TestType(0.5), TestType(damped ? 1 : 0)});
        typename decltype(system)::Force f;
        for (const TestType bad : {Limits::quiet_NaN(), Limits::infinity()}) {
            auto state = system.initial_state();
            state.x(0, 1) = bad;
            system.force(state, f);
            for (Index i = 0; i < 3; ++i) CHECK_FALSE(f.col(i).allFinite());
            state = system.initial_state();
            state.v(0, 2) = bad;
            system.force(state, f);
            CHECK(f.col(0).allFinite());
            CHECK(f.col(1).allFinite() == !damped);
            CHECK(f.col(2).allFinite() == !damped);
        }
        // Finite velocities whose difference is not.
        auto state = system.initial_state();
        state.v(0, 1) = -Limits::max() / 2;
        state.v(0, 2) = Limits::max();
        system.force(state, f);
        CHECK(f.col(0).allFinite());
        CHECK(f.col(2).allFinite() == !damped);
    }
}

}  // namespace taut_test::spring_system_force_test
