// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/suitesparse/suitesparse.hpp>
#include <taut/taut.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::suitesparse_test {

using Sparse = taut::SparseMatrix<double>;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXd random_matrix(Random& random, Index rows, Index columns) {
    MatrixXd A(rows, columns);
    for (Index i = 0; i < A.size(); ++i) A.data()[i] = random.uniform(-1, 1);
    return A;
}

/// Identity, but for −4 in the middle: M + h²K = 1 − 4h² is indefinite at h = 1, singular at ½.
Sparse indefinite() {
    Sparse K(3, 3);
    K.setIdentity();
    K.coeffRef(1, 1) = -4;
    return K;
}

template <class Solver>
VectorXd solution(const Sparse& A, const VectorXd& b) {
    Solver solver;
    solver.analyzePattern(A);
    solver.factorize(A);
    REQUIRE(solver.info() == Eigen::Success);
    return solver.solve(b);
}

/// Steps of (M + hD + h²K) v⁺ = Mv + h(load − Kx), x⁺ = x + hv⁺ by `solver` and densely.
template <class Solver, class System>
void check_steps(const System& system, double h) {
    const Index N = system.size();
    taut::State<double, 1> state{MatrixXd::Ones(1, N), MatrixXd::Ones(1, N)};
    VectorXd x = VectorXd::Ones(N), v = x;
    const MatrixXd D = system.damping(), K = system.stiffness();
    const MatrixXd M = system.mass().asDiagonal();
    taut::ImplicitEuler<System, Solver> stepper(system);
    for (int s = 0; s < 10; ++s) {
        const taut::Report report = stepper.step(state, h);
        REQUIRE(report);
        CHECK(report.residual < Tolerance<double>::accumulated);
        v = dense_solve(M + h * D + h * h * K, M * v + h * (system.load() - K * x));
        x += h * v;
        REQUIRE(distance(state.x.transpose(), x) <= Tolerance<double>::accumulated * largest(x));
    }
}

template <class Solver, class System>
void check_refusal(const System& system, double h, taut::Status status) {
    const MatrixXd ones = MatrixXd::Ones(1, system.size());
    taut::State<double, 1> state{ones, ones};
    taut::ImplicitEuler<System, Solver> stepper(system);
    CHECK(stepper.step(state, h).status == status);
    CHECK((state.x == ones && state.v == ones && state.time == 0));
    CHECK(stepper.step(state, 0.25));
}

}  // namespace

TEST_CASE("cholmod: is a symmetric Solver that solves, steps and reports what is indefinite",
          "[solver]") {
    taut::require_solver<taut::Cholmod<>, double>();
    CHECK(taut::is_symmetric_solver_v<taut::Cholmod<>>);
    Random random(1);
    const MatrixXd root = random_matrix(random, 40, 20);
    MatrixXd K = root * root.transpose();
    K(3, 7) = K(7, 3) = 0;
    K.diagonal().array() += 10;
    const Sparse A = K.sparseView();
    const VectorXd b = random_matrix(random, 40, 1);
    const VectorXd expected = dense_solve(K, b);
    CHECK(distance(solution<taut::Cholmod<>>(A, b), expected) <=
          Tolerance<double>::accumulated * largest(expected));
    using System = taut::LinearSystem<double>;
    check_steps<taut::Cholmod<>>(System(VectorXd::Ones(40), {}, A, b), 0.5);
    check_refusal<taut::Cholmod<>>(System(VectorXd::Ones(3), {}, indefinite()), 1,
                                   taut::Status::not_positive_definite);
}

TEST_CASE("cholmod: nothing free is no failure", "[solver]") {
    taut::SpringSystem<double, 3> cloth = taut::hanging_cloth<double>({2, 2});
    for (Index i = 0; i < 4; ++i) cloth.pin(i);
    auto state = cloth.initial_state();
    taut::ImplicitEuler<taut::SpringSystem<double, 3>, taut::Cholmod<>> stepper(cloth);
    CHECK(stepper.step(state, 0.01));
}

TEST_CASE("cholmod: takes the better of AMD's and METIS's orders, of particles", "[solver]") {
    // A grid of n³ particles: nested dissection needs fewer operations than minimum degree.
    constexpr Index n = 14, N = n * n * n;
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](Index i, Index j, double diagonal) {
        for (Index r = 0; r < 3; ++r) {
            for (Index c = 0; c < 3; ++c) {
                entries.emplace_back(3 * i + r, 3 * j + c, r == c ? diagonal : -0.1);
            }
        }
    };
    for (Index i = 0; i < N; ++i) {
        add(i, i, 9);
        for (const Index step : {Index(1), n, n * n}) {
            if (i / step % n == n - 1) continue;
            add(i, i + step, -1);
            add(i + step, i, -1);
        }
    }
    Sparse A(3 * N, 3 * N);
    A.setFromTriplets(entries.begin(), entries.end());
    const VectorXd b = VectorXd::Ones(3 * N);
    taut::Cholmod<> ours;
    Eigen::CholmodSupernodalLLT<Sparse> amd;
    amd.cholmod().nmethods = 1;
    amd.cholmod().method[0].ordering = CHOLMOD_AMD;
    for (int again = 0; again < 2; ++again) {
        ours.analyzePattern(A);
        amd.analyzePattern(A);
        CHECK(ours.cholmod().fl < 0.9 * amd.cholmod().fl);
    }
    ours.factorize(A);
    REQUIRE(ours.info() == Eigen::Success);
    CHECK(distance(A * ours.solve(b), b) < Tolerance<double>::accumulated);
}

TEST_CASE("cholmod: an analysis that fails is no success", "[solver][bad_input]") {
    taut::Cholmod<> solver;
    const Sparse A = indefinite();
    const int type = solver.cholmod().itype;
    solver.cholmod().itype = CHOLMOD_LONG;  // which the matrix is not
    solver.analyzePattern(A);
    CHECK(solver.info() == Eigen::NumericalIssue);
    solver.factorize(A);
    CHECK(solver.info() == Eigen::NumericalIssue);
    solver.cholmod().itype = type;
}

TEST_CASE("umfpack: is an unsymmetric Solver that solves, steps and reports what is singular",
          "[solver]") {
    taut::require_solver<taut::Umfpack<>, double>();
    CHECK_FALSE(taut::is_symmetric_solver_v<taut::Umfpack<>>);
    Random random(2);
    const MatrixXd root = random_matrix(random, 15, 15), B = random_matrix(random, 15, 15);
    MatrixXd K = root * root.transpose();
    K(2, 9) += 3;
    const Sparse D = (B - B.transpose()).sparseView();
    using System = taut::GeneralLinearSystem<double>;
    const System system((random_matrix(random, 15, 1).array() + 1.5).matrix(), D, K.sparseView(),
                        random_matrix(random, 15, 1));
    const Sparse A = system.stiffness() + system.damping();
    const VectorXd expected = dense_solve(A, system.load());
    CHECK(distance(solution<taut::Umfpack<>>(A, system.load()), expected) <=
          Tolerance<double>::accumulated * largest(expected));
    for (const double h : {0.125, 0.5}) check_steps<taut::Umfpack<>>(system, h);
    check_refusal<taut::Umfpack<>>(System(VectorXd::Ones(3), {}, indefinite()), 0.5,
                                   taut::Status::solver_failed);
}

}  // namespace taut_test::suitesparse_test
