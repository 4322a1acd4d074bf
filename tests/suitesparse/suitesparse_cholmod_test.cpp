// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/solver/sparse_cholesky.hpp>
#include <taut/suitesparse/cholmod.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::suitesparse_cholmod_test {

using Sparse = taut::SparseMatrix<double>;

TEST_CASE("cholmod: is a symmetric Solver", "[solver]") {
    taut::require_solver<taut::Cholmod<>, double>();
    CHECK(taut::is_symmetric_solver_v<taut::Cholmod<>>);
}

TEST_CASE("cholmod: solves what Eigen's LLT solves", "[solver]") {
    const auto cloth = taut::hanging_cloth<double>({12, 9});
    const auto linear = taut::linearize(cloth, cloth.initial_state());
    Sparse A = linear.stiffness();
    A.diagonal() += linear.mass() * 1e4;
    Random random(1);
    const Eigen::VectorXd b = random.points<double, 1>(A.rows(), -1, 1).transpose();
    taut::Cholmod<> cholmod;
    cholmod.analyzePattern(A);
    cholmod.factorize(A);
    REQUIRE(cholmod.info() == Eigen::Success);
    Eigen::SimplicialLLT<Sparse> llt(A);
    const Eigen::VectorXd expected = llt.solve(b);
    CHECK(distance(Eigen::VectorXd(cholmod.solve(b)), expected) <=
          Tolerance<double>::accumulated * largest(expected));
}

TEST_CASE("cholmod: implicit Euler steps as with Eigen's LLT", "[solver]") {
    const auto cloth = taut::hanging_cloth<double>({10, 10});
    using System = std::decay_t<decltype(cloth)>;
    auto by_cholmod = cloth.initial_state();
    auto by_eigen = by_cholmod;
    taut::ImplicitEuler<System, taut::Cholmod<>> cholmod(cloth);
    taut::ImplicitEuler<System, taut::SparseCholesky<double>> eigen(cloth);
    const taut::Report report = cholmod.step(by_cholmod, 1.0 / 60, 20);
    REQUIRE(report);
    CHECK(report.residual < Tolerance<double>::accumulated);
    REQUIRE(eigen.step(by_eigen, 1.0 / 60, 20));
    CHECK(distance(by_cholmod.x, by_eigen.x) <= Tolerance<double>::accumulated * 100);
}

TEST_CASE("cholmod: an indefinite matrix is reported and the state is untouched", "[solver]") {
    Sparse K(3, 3);
    K.setIdentity();
    K.coeffRef(1, 1) = -4;
    const taut::LinearSystem<double> system(Eigen::VectorXd::Ones(3), {}, K);
    taut::State<double, 1> u{Eigen::MatrixXd::Ones(1, 3), Eigen::MatrixXd::Ones(1, 3)};
    const auto before = u;
    taut::ImplicitEuler<taut::LinearSystem<double>, taut::Cholmod<>> stepper(system);
    CHECK(stepper.step(u, 1.0).status == taut::Status::not_positive_definite);
    CHECK(same_bits(u, before));
    CHECK(stepper.step(u, 0.25));
}

TEST_CASE(
    "cholmod: the order of particles fills in no more than CHOLMOD's own, and nothing free is "
    "no failure",
    "[solver]") {
    const auto cloth = taut::hanging_cloth<double>({30, 30});
    const taut::TangentMatrix<double, 3> tangent(cloth);
    auto A = tangent.zero();
    tangent.assemble(cloth, cloth.initial_state().x,
                     taut::matrices::M + 1e-4 * taut::matrices::K_plus, A);
    taut::Cholmod<> ours;
    Eigen::CholmodSupernodalLLT<Sparse> plain;
    for (int again = 0; again < 2; ++again) {
        ours.analyzePattern(A);
        plain.analyzePattern(A);
        CHECK(ours.cholmod().lnz <= 1.1 * plain.cholmod().lnz);
        ours.factorize(A);
        CHECK(ours.info() == Eigen::Success);
    }
    auto pinned = taut::hanging_cloth<double>({2, 2});
    pinned.pin(2);
    pinned.pin(3);
    auto state = pinned.initial_state();
    taut::ImplicitEuler<std::decay_t<decltype(pinned)>, taut::Cholmod<>> stepper(pinned);
    CHECK(stepper.step(state, 0.01));
}

}  // namespace taut_test::suitesparse_cholmod_test
