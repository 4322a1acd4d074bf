// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"
#include "../support/decompositions.hpp"

namespace taut_test::symplectic_euler_test {

TEST_CASE("symplectic_euler: a step satisfies its own update equation", "[integrator]") {
    Random random(1);
    RandomOptions options;
    options.rayleigh = true;
    options.dampers = true;
    const auto system = random_system<double, 3>(random, options);
    auto state = random_state(random, system);
    const auto before = state;
    const double h = 0.03125;
    taut::SymplecticEuler stepper(system);
    const taut::Report report = stepper.step(state, h);
    REQUIRE(report);
    CHECK(report.residual == 0);

    const auto dense = dense_matrices(system, before);
    Eigen::VectorXd v = flat(before.v);
    const Eigen::VectorXd f = flat_force(system, before);
    for (const Index dof : free_dofs(system)) v[dof] += h * f[dof] / dense.M(dof, dof);
    CHECK(distance(flat(state.v), v) <= Tolerance<double>::rounding * largest(v));
    CHECK(distance(flat(state.x), flat(before.x) + h * v) <=
          Tolerance<double>::rounding * largest(v));
    CHECK(state.time == h);
}

TEST_CASE("symplectic_euler: on a linear system a step is that of T5", "[integrator]") {
    const auto springs = linear_scene<double, 2>(true);
    const auto linear = taut::linearize(springs, springs.initial_state());
    Random random(2);
    auto u = random_state(random, linear);
    const auto before = u;
    taut::SymplecticEuler stepper(linear);
    REQUIRE(stepper.step(u, 0.0625));
    const Eigen::MatrixXd K(linear.stiffness());
    const Eigen::MatrixXd D(linear.damping());
    const Eigen::VectorXd f = linear.load() - K * flat(before.x) - D * flat(before.v);
    const Eigen::VectorXd v = flat(before.v) + 0.0625 * f.cwiseQuotient(linear.mass());
    CHECK(distance(flat(u.v), v) <= Tolerance<double>::rounding * largest(v));
    CHECK(distance(flat(u.x), flat(before.x) + 0.0625 * v) <=
          Tolerance<double>::rounding * largest(v));
}

TEST_CASE(
    "symplectic_euler: at half its limit the energy of an undamped system stays within a factor of "
    "3",
    "[integrator]") {
    // v'Mv + x'Kx - h v'Kx is kept exactly; its last term is at most h sqrt(k_max)/2 of the others.
    auto springs = linear_scene<double, 2>(false);
    springs.set_gravity({0, 0});
    const auto start = springs.initial_state();
    const auto linear = taut::linearize(springs, start);
    const auto k = stiffness_eigenvalues(linear);
    const double h = 0.5 * 2 / std::sqrt(k[k.size() - 1]);
    Random random(3);
    taut::State<double, 1> u{random.points<double, 1>(linear.size(), -1, 1),
                             random.points<double, 1>(linear.size(), -1, 1)};
    // Energies about the equilibrium, where the load is balanced.
    const Eigen::MatrixXd K(linear.stiffness());
    const taut::LinearSystem<double> unloaded(linear.mass(), {}, linear.stiffness());
    const double first = unloaded.energy(u);
    taut::SymplecticEuler stepper(unloaded);
    for (int i = 0; i < 2000; ++i) {
        REQUIRE(stepper.step(u, h));
        REQUIRE(unloaded.energy(u) <= 3 * first * (1 + Tolerance<double>::accumulated));
        REQUIRE(unloaded.energy(u) >= first / 3 * (1 - Tolerance<double>::accumulated));
    }
}

TEMPLATE_TEST_CASE("symplectic_euler: angular momentum is kept to rounding, axial dampers included",
                   "[integrator]", float, double) {
    Random random(4);
    RandomOptions options;
    options.pinned = 0;
    options.gravity = false;
    options.dampers = true;
    const auto system = random_system<TestType, 3>(random, options);
    auto state = random_state(random, system);
    const auto momentum = [&] {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (Index i = 0; i < system.size(); ++i) {
            const Eigen::Vector3d x = state.x.col(i).template cast<double>();
            const Eigen::Vector3d v = state.v.col(i).template cast<double>();
            sum += static_cast<double>(system.mass(i)) * Eigen::Vector3d(x[1] * v[2] - x[2] * v[1],
                                                                         x[2] * v[0] - x[0] * v[2],
                                                                         x[0] * v[1] - x[1] * v[0]);
        }
        return sum;
    };
    const Eigen::Vector3d before = momentum();
    taut::SymplecticEuler stepper(system);
    REQUIRE(stepper.step(state, TestType(0.001), 400));
    CHECK(distance(momentum(), before) <= Tolerance<TestType>::accumulated);
}

TEST_CASE("symplectic_euler: the external force sees the state of the step's start",
          "[integrator]") {
    Random random(5);
    auto system = random_system<double, 2>(random);
    auto state = random_state(random, system);
    auto expected = state;
    int calls = 0;
    system.set_external_force([&](const auto& given, auto& f) {
        CHECK(same_bits(given, expected));
        CHECK(f.cols() == given.x.cols());
        ++calls;
    });
    taut::SymplecticEuler stepper(system);
    for (int i = 0; i < 5; ++i) {
        REQUIRE(stepper.step(state, 0.001));
        expected = state;
    }
    CHECK(calls == 5);
}

TEST_CASE("symplectic_euler: a force that is not finite is divergence, and names its particle",
          "[integrator]") {
    Random random(6);
    auto system = random_system<double, 2>(random);
    system.set_external_force(
        [](const auto&, auto& f) { f(1, 5) = std::numeric_limits<double>::quiet_NaN(); });
    auto state = random_state(random, system);
    const auto before = state;
    taut::SymplecticEuler stepper(system);
    const taut::Report report = stepper.step(state, 0.001, 3);
    CHECK(report.status == taut::Status::diverged);
    CHECK(report.iterations == 0);
    CHECK(report.where == 5);
    CHECK(same_bits(state, before));
}

}  // namespace taut_test::symplectic_euler_test
