// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseLU>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/suitesparse/umfpack.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::suitesparse_umfpack_test {

using Sparse = taut::SparseMatrix<double>;
using System = taut::GeneralLinearSystem<double>;

namespace {

System unsymmetric(Random& random) {
    const Eigen::MatrixXd A = random.points<double, 15>(15, -1, 1);
    const Eigen::MatrixXd B = random.points<double, 15>(15, -1, 1);
    Eigen::MatrixXd K = A * A.transpose();
    K(2, 9) += 3;
    const Eigen::MatrixXd D = B - B.transpose();
    return {random.vector<double, 15>(0.5, 2), D.sparseView(), K.sparseView(),
            random.vector<double, 15>(-1, 1)};
}

}  // namespace

TEST_CASE("umfpack: is a Solver, and not a symmetric one", "[solver]") {
    taut::require_solver<taut::Umfpack<>, double>();
    CHECK_FALSE(taut::is_symmetric_solver_v<taut::Umfpack<>>);
}

TEST_CASE("umfpack: solves what SparseLU solves", "[solver]") {
    Random random(1);
    const auto system = unsymmetric(random);
    Sparse A = system.stiffness() + system.damping();
    A.makeCompressed();
    taut::Umfpack<> umfpack;
    umfpack.analyzePattern(A);
    umfpack.factorize(A);
    REQUIRE(umfpack.info() == Eigen::Success);
    Eigen::SparseLU<Sparse> lu(A);
    const Eigen::VectorXd expected = lu.solve(system.load());
    CHECK(distance(Eigen::VectorXd(umfpack.solve(system.load())), expected) <=
          Tolerance<double>::accumulated * largest(expected));
}

TEST_CASE("umfpack: implicit Euler on an unsymmetric system steps as with SparseLU", "[solver]") {
    Random random(2);
    const auto system = unsymmetric(random);
    auto by_umfpack = random_state(random, system);
    auto by_eigen = by_umfpack;
    taut::ImplicitEuler<System, taut::Umfpack<>> umfpack(system);
    taut::ImplicitEuler<System, Eigen::SparseLU<Sparse>> eigen(system);
    for (const double h : {0.125, 0.5}) {
        const taut::Report report = umfpack.step(by_umfpack, h, 10);
        REQUIRE(report);
        CHECK(report.residual < Tolerance<double>::accumulated);
        REQUIRE(eigen.step(by_eigen, h, 10));
        CHECK(distance(by_umfpack.x, by_eigen.x) <= Tolerance<double>::accumulated);
    }
}

TEST_CASE("umfpack: a singular matrix is reported and the state is untouched", "[solver]") {
    Sparse K(2, 2);
    K.setIdentity();
    K.coeffRef(1, 1) = -4;  // M + h²K = 1 − 4h² vanishes at h = ½
    const System system(Eigen::VectorXd::Ones(2), {}, K);
    taut::State<double, 1> u{Eigen::MatrixXd::Ones(1, 2), Eigen::MatrixXd::Ones(1, 2)};
    const auto before = u;
    taut::ImplicitEuler<System, taut::Umfpack<>> stepper(system);
    CHECK_FALSE(stepper.step(u, 0.5));
    CHECK(same_bits(u, before));
    CHECK(stepper.step(u, 0.25));
}

}  // namespace taut_test::suitesparse_umfpack_test
