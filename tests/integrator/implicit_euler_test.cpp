// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseLU>
#include <cmath>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/direct_euler.hpp"
#include "../support/decompositions.hpp"
#include "../support/random_system.hpp"
#include "../support/returning_steps.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::implicit_euler_test {

using taut::GeneralLinearSystem;
using taut::ImplicitEuler;
using taut::LinearSystem;
using taut::Status;

namespace {

using Sparse = taut::SparseMatrix<double>;
using LinearState = taut::State<double, 1>;

Eigen::MatrixXd draw_matrix(Random& random) { return random.points<double, 12>(12, -1, 1); }

LinearState draw_state(Random& random, Index n) {
    return {random.points<double, 1>(n, -1, 1), random.points<double, 1>(n, -1, 1)};
}

Sparse sparse(const Eigen::MatrixXd& dense) { return dense.sparseView(); }

/// The state after one step of [T6], from dense matrices.
LinearState dense_step(const GeneralLinearSystem<double>& system, LinearState u, double h) {
    const Eigen::MatrixXd M = system.mass().asDiagonal();
    const Eigen::MatrixXd K(system.stiffness());
    const Eigen::MatrixXd D(system.damping());
    const Eigen::VectorXd b = M * flat(u.v) + h * (system.load() - K * flat(u.x));
    u.v = dense_solve(M + h * D + h * h * K, b).transpose();
    u.x += h * u.v;
    return u;
}

}  // namespace

TEMPLATE_TEST_CASE("implicit_euler: a step satisfies its own update equation", "[integrator]",
                   (taut::SpringSystem<double, 1>),
                   (taut::SpringSystem<double, 3, taut::Hookean, Glue>)) {
    for (const double h : {0.001, 0.0625, 2.0}) {
        Random random(1);
        RandomOptions options;
        options.rayleigh = true;
        options.dampers = true;
        auto system = random_like<TestType>(random, options);
        system.pin(5);
        auto state = random_state(random, system);  // pinned particles move, too
        const auto before = state;
        DirectEuler stepper(system);
        const taut::Report report = stepper.step(state, h);
        REQUIRE(report);
        CHECK(report.residual < Tolerance<double>::accumulated);

        // (M + hD + h²K⁺)(v⁺ − v) = h(f − hK⁺v) on the free, with v of the pinned ones on the
        // right.
        const auto dense = dense_matrices(system, before);
        const auto free = free_dofs(system);
        const Eigen::MatrixXd A = dense.M + h * dense.D + h * h * dense.K_plus;
        const Eigen::VectorXd b =
            h * (flat_force(system, before) - h * dense.K_plus * flat(before.v));
        Eigen::VectorXd v = flat(before.v);
        v(free) += dense_solve(A(free, free), b(free));
        CHECK(distance(flat(state.v), v) <= Tolerance<double>::accumulated * largest(v));
        CHECK(distance(flat(state.x), flat(before.x) + h * flat(state.v)) <=
              Tolerance<double>::rounding * largest(v));
        CHECK(state.time == h);
    }
}

TEST_CASE("implicit_euler: a linear system's step is that of T6", "[integrator]") {
    Random random(2);
    const Eigen::MatrixXd A = draw_matrix(random);
    const Eigen::MatrixXd B = draw_matrix(random);
    const LinearSystem<double> system(
        random.vector<double, 12>(0.5, 2),
        sparse(A + A.transpose() + 12 * Eigen::MatrixXd::Identity(12, 12)),
        sparse(B * B.transpose()), random.vector<double, 12>(-1, 1));
    ImplicitEuler stepper(system);
    auto u = draw_state(random, 12);
    for (const double h : {0.125, 0.125, 4.0, 0.125}) {  // changes of h between steps are taken up
        const auto expected = dense_step(system, u, h);
        const taut::Report report = stepper.step(u, h);
        REQUIRE(report);
        CHECK(report.residual < Tolerance<double>::accumulated);
        CHECK(distance(u.v, expected.v) <= Tolerance<double>::accumulated);
        CHECK(distance(u.x, expected.x) <= Tolerance<double>::accumulated * 10);
    }
}

TEST_CASE("implicit_euler: an unsymmetric system is stepped by SparseLU, as a dense solve does",
          "[integrator]") {
    Random random(3);
    const Eigen::MatrixXd B = draw_matrix(random);
    Eigen::MatrixXd K = B * B.transpose();
    K(0, 5) += 2;
    Eigen::MatrixXd gyroscopic = draw_matrix(random);
    gyroscopic = (gyroscopic - gyroscopic.transpose()).eval();
    const GeneralLinearSystem<double> system(random.vector<double, 12>(0.5, 2), sparse(gyroscopic),
                                             sparse(K), random.vector<double, 12>(-1, 1));
    ImplicitEuler<GeneralLinearSystem<double>, Eigen::SparseLU<Sparse>> stepper(system);
    CHECK_FALSE(stepper.symmetric);
    auto u = draw_state(random, 12);
    for (int i = 0; i < 5; ++i) {
        const auto expected = dense_step(system, u, 0.125);
        REQUIRE(stepper.step(u, 0.125));
        CHECK(distance(u.v, expected.v) <= Tolerance<double>::accumulated);
        CHECK(distance(u.x, expected.x) <= Tolerance<double>::accumulated);
    }
}

TEST_CASE("implicit_euler: any of Eigen's symmetric solvers gives the same step", "[integrator]") {
    Random random(4);
    const auto system = random_system<double, 3>(random);
    const auto start = random_state(random, system);
    using System = std::decay_t<decltype(system)>;
    auto by_llt = start;
    auto by_upper = start;
    auto by_lu = start;
    DirectEuler llt(system);
    ImplicitEuler<System, Eigen::SimplicialLLT<Sparse, Eigen::Upper>> upper(system);
    ImplicitEuler<System, Eigen::SparseLU<Sparse>> lu(system);
    REQUIRE(llt.step(by_llt, 0.01, 20));
    REQUIRE(upper.step(by_upper, 0.01, 20));
    REQUIRE(lu.step(by_lu, 0.01, 20));
    CHECK(distance(by_llt.x, by_upper.x) <= Tolerance<double>::accumulated);
    CHECK(distance(by_llt.x, by_lu.x) <= Tolerance<double>::accumulated);
}

TEMPLATE_TEST_CASE(
    "implicit_euler: on crumpled poses the step matrix is positive definite at every h",
    "[integrator]", (taut::SpringSystem<double, 2>),
    (taut::SpringSystem<double, 3, taut::Hookean, Glue>)) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        RandomOptions options;
        options.pinned = random.below(3);
        options.dampers = seed % 2 == 0;
        options.rayleigh = seed % 3 == 0;
        const auto system = random_like<TestType>(random, options);
        auto crumpled = random_state(random, system);
        crumpled.x *= 0.3;
        crumpled.x.col(3) = crumpled.x.col(4);  // two particles in one place
        const auto dense = dense_matrices(system, crumpled);
        const auto free = free_dofs(system);
        for (const double h : {1e-3, 0.1, 10.0, 1e3}) {
            INFO("seed " << seed << ", h " << h);
            auto state = crumpled;
            ImplicitEuler stepper(system);
            const taut::Report report = stepper.step(state, h, 5);
            CHECK(report);
            CHECK(state.finite());
            const Eigen::MatrixXd A = (dense.M + h * dense.D + h * h * dense.K_plus)(free, free);
            CHECK(least_eigenvalue(A) >
                  0.5 - Tolerance<double>::rounding * largest(A));  // masses are ≥ ½
        }
    }
}

TEST_CASE("implicit_euler: the energy of a linear system never rises, at any step",
          "[integrator]") {
    Random random(5);
    const Eigen::MatrixXd A = draw_matrix(random);
    const Eigen::MatrixXd B = draw_matrix(random);
    const Eigen::VectorXd mass = random.vector<double, 12>(0.5, 2);
    for (const bool damped : {false, true}) {
        for (const double h : {0.01, 1.0, 100.0}) {
            const LinearSystem<double> system(mass, damped ? sparse(A * A.transpose()) : Sparse(),
                                              sparse(B * B.transpose()));
            auto u = draw_state(random, 12);
            ImplicitEuler stepper(system);
            const double first = system.energy(u);
            double energy = first;
            for (int i = 0; i < 200; ++i) {
                REQUIRE(stepper.step(u, h));
                const double next = system.energy(u);
                REQUIRE(next <= energy + Tolerance<double>::rounding * first);
                energy = next;
            }
            CHECK(energy < first);
        }
    }
}

TEST_CASE("implicit_euler: one undamped mode decays by 1/sqrt(1 + z^2) a step", "[integrator]") {
    Sparse K(1, 1);
    K.insert(0, 0) = 4;
    const LinearSystem<double> system(Eigen::VectorXd::Ones(1), {}, K);
    LinearState u{Eigen::MatrixXd::Ones(1, 1), LinearState::zero(1)};
    ImplicitEuler stepper(system);
    REQUIRE(stepper.step(u, 0.125, 64));
    const double size = std::hypot(u.x(0, 0), u.v(0, 0) / 2);
    CHECK_THAT(size, Catch::Matchers::WithinRel(std::pow(1 + 0.0625, -32),
                                                Tolerance<double>::accumulated));
}

TEST_CASE("implicit_euler: an indefinite step matrix is reported, not solved", "[integrator]") {
    // M + h²K = 1 − 4h² is positive up to h = ½ [T21].
    Sparse K(3, 3);
    K.setIdentity();
    K.coeffRef(1, 1) = -4;
    const LinearSystem<double> system(Eigen::VectorXd::Ones(3), {}, K);
    Random random(6);
    auto u = draw_state(random, 3);
    const auto before = u;
    ImplicitEuler stepper(system);
    CHECK(stepper.step(u, 1.0).status == Status::not_positive_definite);
    CHECK(stepper.step(u, 0.505).status == Status::not_positive_definite);
    CHECK(stepper.step(u, 0.505).status ==
          Status::not_positive_definite);  // asked twice, told twice
    CHECK(same_bits(u, before));
    CHECK(stepper.step(u, 0.495));
    CHECK_FALSE(same_bits(u, before));
}

TEST_CASE("implicit_euler: a solver whose solution is not finite is reported with the particle",
          "[integrator]") {
    Random random(7);
    auto system = random_system<double, 2>(random);
    system.set_external_force(
        [](const auto&, auto& f) { f(1, 5) = std::numeric_limits<double>::quiet_NaN(); });
    auto state = random_state(random, system);
    const auto before = state;
    ImplicitEuler stepper(system);
    const taut::Report report = stepper.step(state, 0.01, 2);
    CHECK_FALSE(report);
    CHECK(report.where >= 2);  // a free one
    CHECK(report.where < system.size());
    CHECK(same_bits(state, before));
}

TEST_CASE("implicit_euler: the external force is asked once a step, for the state of its start",
          "[integrator]") {
    Random random(8);
    auto system = random_system<double, 2>(random);
    auto state = random_state(random, system);
    auto expected = state;
    int calls = 0;
    system.set_external_force([&](const auto& given, auto&) {
        CHECK(same_bits(given, expected));
        ++calls;
    });
    ImplicitEuler stepper(system);
    for (int i = 0; i < 4; ++i) {
        REQUIRE(stepper.step(state, 0.01));
        expected = state;
    }
    CHECK(calls == 4);
}

TEST_CASE("implicit_euler: matrices are factorised once for each of the last two h",
          "[integrator]") {
    Random random(7);
    const auto springs = random_system<double, 3>(random);
    const auto linear = taut::linearize(springs, springs.initial_state());
    auto u = linear.initial_state();
    ImplicitEuler stepper(linear);
    for (const auto& [h, expected] : returning_steps) {
        REQUIRE(stepper.step(u, h, 2));
        CHECK(stepper.factorizations() == expected);
        auto again = u;
        auto by_fresh = u;
        ImplicitEuler fresh(linear);
        REQUIRE(stepper.step(again, h));
        REQUIRE(fresh.step(by_fresh, h));
        CHECK(same_bits(again, by_fresh));
    }
    auto state = springs.initial_state();
    ImplicitEuler moving(springs);
    REQUIRE(moving.step(state, 0.01, 3));
    CHECK(moving.factorizations() == 3);
}

TEST_CASE("implicit_euler: float steps follow double ones", "[integrator]") {
    Random first(9);
    Random second(9);
    const auto narrow = random_system<float, 3>(first);
    const auto wide = random_system<double, 3>(second);
    auto narrow_state = random_state(first, narrow);
    auto wide_state = random_state(second, wide);
    DirectEuler narrow_stepper(narrow);
    DirectEuler wide_stepper(wide);
    REQUIRE(narrow_stepper.step(narrow_state, 0.01F, 10));
    REQUIRE(wide_stepper.step(wide_state, 0.01, 10));
    CHECK(distance(narrow_state.x, wide_state.x) < Tolerance<float>::accumulated);
    CHECK(distance(narrow_state.v, wide_state.v) <
          Tolerance<float>::accumulated * largest(wide_state.v));
}

TEMPLATE_TEST_CASE("implicit_euler: the default solver errs far less than the step does",
                   "[integrator][slow]", float, double) {
    for (const double stretch : {1e2, 1e3, 1e5}) {
        for (const double step : {1.0 / 60, 1.0 / 240}) {
            INFO("stretch " << stretch << ", h " << step);
            taut::ClothOptions options{10, 12};
            options.stretch = stretch;
            options.bend = stretch / 10;
            const auto cloth = taut::hanging_cloth<TestType>(options);
            const auto h = static_cast<TestType>(step);
            auto state = cloth.initial_state();
            ImplicitEuler by_default(cloth);
            for (int k = 0; k < 30; ++k) {
                auto exact = state;
                auto fine = state;
                DirectEuler direct(cloth);
                REQUIRE(direct.step(exact, h));
                REQUIRE(direct.step(fine, h / 8, 8));
                REQUIRE(by_default.step(state, h));
                CHECK(distance(state.x, exact.x) <= 0.2 * distance(exact.x, fine.x));
            }
        }
    }
}

}  // namespace taut_test::implicit_euler_test
