// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <limits>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/solver/conjugate_gradient.hpp>
#include <taut/solver/sparse_cholesky.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/stiff_chain.hpp"
#include "../support/tolerance.hpp"
#include "step_matrices.hpp"

namespace taut_test::conjugate_gradient_test {

using taut::ConjugateGradient;
using taut::ImplicitEuler;
using taut::Status;

namespace {

template <class Scalar, int Dim>
void check_solves(Random& random, double h) {
    const taut::SparseMatrix<Scalar> A =
        random_step_matrix(random, Dim, 20, 60, h).template cast<Scalar>();
    const taut::VectorX<Scalar> b = random.points<Scalar, 1>(A.rows(), -1, 1).transpose();
    ConjugateGradient<Scalar, Dim> solver;
    solver.analyzePattern(A);
    solver.factorize(A);
    REQUIRE(solver.info() == Eigen::Success);
    for (const double tolerance : {0.1, 1e-3, 1e3 * Tolerance<Scalar>::epsilon}) {
        solver.setTolerance(static_cast<Scalar>(tolerance));
        const taut::VectorX<Scalar> x = solver.solve(b);
        CHECK(solver.info() == Eigen::Success);
        CHECK(solver.iterations() > 0);
        const double residual = static_cast<double>((b - A * x).norm() / b.norm());
        CHECK(residual <= 1.01 * tolerance + Tolerance<Scalar>::rounding);
        CHECK(std::abs(static_cast<double>(solver.error()) - residual) <=
              Tolerance<Scalar>::rounding);
    }
    // What was solved before changes nothing.
    const taut::VectorX<Scalar> x = solver.solve(b);
    solver.solve(taut::VectorX<Scalar>::Ones(b.size()));
    CHECK(solver.solve(b) == x);
}

}  // namespace

TEST_CASE("conjugate_gradient: the residual it promises is the true one", "[solver]") {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const double h = seed % 2 == 0 ? 0.01 : 0.3;
        check_solves<double, 1>(random, h);
        check_solves<double, 2>(random, h);
        check_solves<double, 3>(random, h);
        check_solves<float, 3>(random, h);
        check_solves<long double, 2>(random, h);
    }
}

TEST_CASE("conjugate_gradient: an indefinite matrix is reported, in the blocks or on the way",
          "[solver]") {
    taut::SparseMatrix<double> A(4, 4);
    A.setIdentity();
    A.coeffRef(0, 1) = A.coeffRef(1, 0) = 3;  // eigenvalues 4 and −2
    A.makeCompressed();
    ConjugateGradient<double, 1> solver;
    solver.analyzePattern(A);
    solver.factorize(A);
    CHECK(solver.info() == Eigen::Success);
    Eigen::Vector4d b(1, -1, 0, 0);
    solver.solve(b);
    CHECK(solver.info() == Eigen::NumericalIssue);
    A.coeffRef(2, 2) = -1;
    solver.factorize(A);
    CHECK(solver.info() == Eigen::NumericalIssue);

    taut::SparseMatrix<double> K(3, 3);
    K.setIdentity();
    K.coeffRef(1, 1) = -4;
    const taut::LinearSystem<double> system(Eigen::VectorXd::Ones(3), {}, K);
    taut::State<double, 1> u{Eigen::MatrixXd::Ones(1, 3), Eigen::MatrixXd::Ones(1, 3)};
    const auto before = u;
    ImplicitEuler<taut::LinearSystem<double>, ConjugateGradient<double, 1>> stepper(system);
    CHECK(stepper.step(u, 1.0).status == Status::not_positive_definite);
    CHECK(same_bits(u, before));
    CHECK(stepper.step(u, 0.25));
}

TEST_CASE("conjugate_gradient: an indefinite matrix that float takes for singular is reported",
          "[solver]") {
    for (const double beyond : {1e-3, 1e-6, 1e-9, 1e-12}) {
        INFO("1 + " << beyond);
        taut::SparseMatrix<double> A(2, 2);
        A.coeffRef(0, 0) = A.coeffRef(1, 1) = 1;
        A.coeffRef(0, 1) = A.coeffRef(1, 0) = 1 + beyond;
        A.makeCompressed();
        const Eigen::Vector2d b(1, -1);
        ConjugateGradient<double, 1> solver;
        solver.analyzePattern(A);
        solver.factorize(A);
        solver.solve(b);
        CHECK(solver.info() == Eigen::NumericalIssue);
    }
}

TEST_CASE("conjugate_gradient: the unit of mass changes nothing, within the range of double",
          "[solver][extremes]") {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        Random random(seed);
        const auto A = random_step_matrix(random, 3, 20, 60, 0.3);
        const Eigen::VectorXd b = random.points<double, 1>(A.rows(), -1, 1).transpose();
        ConjugateGradient<double, 3> solver;
        solver.setTolerance(1e-10);
        solver.analyzePattern(A);
        solver.factorize(A);
        const Eigen::VectorXd expected = solver.solve(b);
        const Index iterations = solver.iterations();
        for (const int exponent : {-500, -400, -150, -100, -20, 20, 100, 150, 400, 500}) {
            INFO("seed " << seed << ", 2^" << exponent);
            const double unit = std::ldexp(1.0, exponent);
            solver.factorize(unit * A);
            REQUIRE(solver.info() == Eigen::Success);
            const Eigen::VectorXd x = solver.solve(unit * b);
            CHECK(solver.info() == Eigen::Success);
            CHECK((x - expected).norm() <= 1e-8 * expected.norm());
            CHECK(solver.iterations() <= iterations + 5);
        }
    }
}

TEST_CASE("conjugate_gradient: masses over more decades than float has are solved in double",
          "[solver][extremes]") {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        taut::SparseMatrix<double> A = random_step_matrix(random, 3, 20, 60, 0.3);
        Eigen::VectorXd scale(A.rows());
        for (Index i = 0; i < A.rows(); i += 3) {
            scale.segment<3>(i).setConstant(std::ldexp(1.0, static_cast<int>(random.below(120))));
        }
        A = scale.asDiagonal() * A * scale.asDiagonal();
        const Eigen::VectorXd y = random.points<double, 1>(A.rows(), -1, 1).transpose();
        const Eigen::VectorXd x = y.cwiseQuotient(scale);
        ConjugateGradient<double, 3> solver;
        solver.setTolerance(1e-12);
        solver.analyzePattern(A);
        solver.factorize(A);
        REQUIRE(solver.info() == Eigen::Success);
        const Eigen::VectorXd b = A * x;
        solver.solve(b);
        CHECK(solver.info() == Eigen::Success);
        CHECK(solver.error() <= 1e-12);
    }
}

TEST_CASE("conjugate_gradient: the cap of iterations is reported and the state untouched",
          "[solver]") {
    const auto chain = stiff_chain();
    using System = std::decay_t<decltype(chain)>;
    auto state = chain.initial_state();
    ImplicitEuler<System, ConjugateGradient<double, 1>> stepper(chain);
    REQUIRE(stepper.step(state, 1e-8, 3));
    const auto before = state;
    stepper.configure([](auto& solver) { solver.setTolerance(1e-13); });
    CHECK(stepper.step(state, 1.0).status == Status::not_converged);
    CHECK(stepper.solver().iterations() == 8 * chain.size());
    CHECK(same_bits(state, before));
    stepper.configure([](auto& solver) { solver.setTolerance(1e-3); });
    CHECK(stepper.step(state, 1e-8));
}

TEST_CASE("conjugate_gradient: a step follows Cholesky's within its tolerance", "[solver][slow]") {
    const auto cloth = taut::hanging_cloth<double>({16, 16});
    using System = std::decay_t<decltype(cloth)>;
    using Stepper = ImplicitEuler<System, ConjugateGradient<double, 3>>;
    auto by_gradients = cloth.initial_state();
    auto by_factors = by_gradients;
    Stepper gradients(cloth);
    gradients.configure([](auto& solver) { solver.setTolerance(1e-10); });
    ImplicitEuler<System, taut::SparseCholesky<double>> factors(cloth);
    for (int i = 0; i < 20; ++i) {
        const taut::Report report = gradients.step(by_gradients, 1.0 / 60);
        REQUIRE(report);
        CHECK(report.residual <= 1.1e-10);
        REQUIRE(factors.step(by_factors, 1.0 / 60));
    }
    CHECK(distance(by_gradients.x, by_factors.x) <= 1e-6);
}

TEST_CASE("conjugate_gradient: a wrong setting and a matrix without blocks are refused by name",
          "[solver][bad_input]") {
    ConjugateGradient<double, 3> solver;
    CHECK(missing(message_of([&] { solver.setTolerance(0); }),
                  {"ConjugateGradient", "tolerance is 0", "> 0"})
              .empty());
    CHECK_FALSE(
        message_of([&] { solver.setTolerance(std::numeric_limits<double>::quiet_NaN()); }).empty());
    taut::SparseMatrix<double> A(6, 6);
    A.setIdentity();
    CHECK(missing(message_of([&] { solver.analyzePattern(A); }),
                  {"column 0", "no full 3 by 3 blocks"})
              .empty());
    CHECK_FALSE(
        message_of([&] { solver.analyzePattern(taut::SparseMatrix<double>(4, 4)); }).empty());
    taut::SparseMatrix<double> shifted(6, 6);  // column 1 has other rows than column 0
    for (int j = 0; j < 6; ++j) {
        for (int i = 0; i < 3; ++i) shifted.insert((j == 1 ? 3 : j / 3 * 3) + i, j) = 1;
    }
    shifted.makeCompressed();
    CHECK(missing(message_of([&] { solver.analyzePattern(shifted); }), {"column 1"}) == "");
}

}  // namespace taut_test::conjugate_gradient_test
