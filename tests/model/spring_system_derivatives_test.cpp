// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// Force against energy, K and D against force. Other tests of forces: spring_system_force_test.cpp.
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/random_system.hpp"
#include "../support/decompositions.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::spring_system_derivatives_test {

using taut::Hookean;
using taut::Spring;
using taut::SpringSystem;

namespace {

template <class System>
Eigen::VectorXd energy_gradient(const System& system, typename System::State state, double h) {
    Eigen::VectorXd gradient(state.x.size());
    for (Index j = 0; j < state.x.size(); ++j) {
        auto& entry = state.x.data()[j];
        const auto before = entry;
        entry = before + h;
        const double up = system.potential_energy(state);
        entry = before - h;
        const double down = system.potential_energy(state);
        entry = before;
        gradient[j] = (up - down) / (2 * h);
    }
    return gradient;
}

/// Everything the model promises of a pose, against differences and against naive dense assembly.
template <class System>
void check_derivatives(const System& system, const typename System::State& state) {
    const double difference = Tolerance<double>::difference;
    const double rounding = Tolerance<double>::rounding;
    const double h = 1e-5;
    auto still = state;
    still.v.setZero();

    const Eigen::VectorXd f = flat_force(system, still);
    CHECK(distance(f, -energy_gradient(system, still, h)) < difference * (1 + largest(f)));

    const auto dense = dense_matrices(system, state);
    const auto free = free_dofs(system);
    const auto linear = system.linearize(state);
    const Eigen::MatrixXd K(linear.stiffness());
    const Eigen::MatrixXd D(linear.damping());
    CHECK(distance(K, dense.K(free, free)) <= rounding * largest(dense.K));
    CHECK(distance(D, dense.D(free, free)) <= rounding * largest(dense.D));
    CHECK(distance(linear.mass(), Eigen::VectorXd(dense.M.diagonal()(free))) == 0);
    CHECK(distance(linear.load(), f(free)) <= rounding * largest(f));

    const Eigen::MatrixXd by_x = difference_quotient(system, still, false, h);
    CHECK(distance(K, by_x(free, free)) < difference * (1 + largest(dense.K)));
    // Forces are linear in v: any step will do, about any velocity.
    const Eigen::MatrixXd by_v = difference_quotient(system, state, true, 0.5);
    CHECK(distance(D, by_v(free, free)) <= rounding * (1 + largest(f) + largest(dense.K)));
}

}  // namespace

TEMPLATE_TEST_CASE("spring_system: force is -grad(energy), K is -df/dx and D is -df/dv", "[model]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        RandomOptions options;
        options.pinned = random.below(4);
        options.dampers = seed % 2 == 0;
        options.rayleigh = seed % 3 == 0;
        const auto system = random_system<double, TestType::Dim>(random, options);
        const auto state = random_state(random, system);
        INFO("seed " << seed);
        check_derivatives(system, state);
    }
}

TEMPLATE_TEST_CASE("spring_system: the same derivatives hold with several laws in one system",
                   "[model]", (SpringSystem<double, 1, Glue>),
                   (SpringSystem<double, 2, TensionOnly, Hookean>),
                   (SpringSystem<double, 2, Buckling>),
                   (SpringSystem<double, 3, Hookean, TensionOnly, Glue>)) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        RandomOptions options;
        options.springs = 9;
        options.dampers = seed % 2 == 0;
        options.rayleigh = seed % 3 == 0;
        const auto system = random_like<TestType>(random, options);
        const auto state = random_state(random, system);
        INFO("seed " << seed);
        check_derivatives(system, state);
    }
}

TEMPLATE_TEST_CASE(
    "spring_system: at rest and 1e-8 off it, force and tangent are those of the rest pose",
    "[model]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    constexpr int Dim = TestType::Dim;
    Random random(4);
    SpringSystem<double, Dim> system;
    for (int i = 0; i < 6; ++i) system.add_particle(random.vector<double, Dim>(-1, 1), 1);
    for (int i = 0; i < 6; ++i) system.add_spring(i, (i + 1) % 6, 100);
    auto state = system.initial_state();
    CHECK(largest(flat_force(system, state)) == 0);
    const Eigen::MatrixXd K(system.linearize(state).stiffness());

    const Eigen::VectorXd u = flat(random.points<double, Dim>(6, -1e-8, 1e-8));
    state.x += Eigen::Map<const Eigen::Matrix<double, Dim, Eigen::Dynamic>>(u.data(), Dim, 6);
    CHECK(distance(flat_force(system, state), -K * u) <
          Tolerance<double>::difference * 100 * largest(u));
    CHECK(distance(Eigen::MatrixXd(system.linearize(state).stiffness()), K) <
          100 * Tolerance<double>::difference);
}

TEMPLATE_TEST_CASE(
    "spring_system: Rayleigh's D is d0 M + alpha K+, and semi-definite at crumpled poses",
    "[model]", (SpringSystem<double, 1, Hookean>), (SpringSystem<double, 2, Hookean>),
    (SpringSystem<double, 3, Hookean, Glue>)) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        RandomOptions options;
        options.rayleigh = true;
        const auto system = random_like<TestType>(random, options);
        auto state = random_state(random, system);
        state.x *= 0.4;  // most springs are compressed
        const auto linear = system.linearize(state);
        const auto dense = dense_matrices(system, state);
        const auto free = free_dofs(system);
        const Eigen::MatrixXd D(linear.damping());
        const Eigen::MatrixXd K(linear.stiffness());
        const Eigen::MatrixXd K_plus = dense.K_plus(free, free);
        const double rounding = Tolerance<double>::rounding * largest(K_plus);
        CHECK(distance(D, 0.25 * dense.M(free, free) + 0.0078125 * K_plus) <= rounding);
        CHECK(least_eigenvalue(D - 0.25 * dense.M(free, free)) >= -rounding);
        CHECK(least_eigenvalue(K_plus) >= -rounding);
        CHECK(least_eigenvalue(K_plus - K) >= -rounding);
        if (TestType::Dim > 1) CHECK(least_eigenvalue(K) < 0);  // the pose is a hard one
    }
}

}  // namespace taut_test::spring_system_derivatives_test
