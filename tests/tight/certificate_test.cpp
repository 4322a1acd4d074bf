// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/tight/certificate.hpp>
#include <taut/stability/spring_pencil.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "definite_matrices.hpp"

namespace taut_test::certificate_test {

namespace matrices = taut::matrices;

using taut::proves_positive_definite;

// One false proof would make every certificate worthless, so most of these matrices have a least
// eigenvalue just below zero.

namespace {

/// Both with the given matrix and scaled.
void check_refused(Random& random, const Sparse& A) {
    CHECK_FALSE(proves_positive_definite(A).proved);
    CHECK_FALSE(proves_positive_definite(badly_scaled(random, A, 60)).proved);
}

}  // namespace

TEST_CASE("certificate: grids and rows a hair below definite are not proved", "[stability]") {
    Random random(200);
    int tested = 0;
    for (const auto& [p, q] : {std::pair<Index, Index>{1, 1},
                               {2, 1},
                               {3, 1},
                               {10, 1},
                               {100, 1},
                               {3000, 1},
                               {2, 2},
                               {5, 3},
                               {12, 12},
                               {30, 20}}) {
        const double critical = static_cast<double>(-grid_least(p, q, 0));
        for (const double hair : hairs) {
            const double diagonal = critical * (1 - hair);
            // Where rounding has put the diagonal above, or on the spot.
            if (!(diagonal > 0) || !(grid_least(p, q, diagonal) < -1e-18L)) continue;
            ++tested;
            INFO(p << " x " << q << ", " << hair);
            check_refused(random, grid(p, q, diagonal));
        }
    }
    CHECK(tested > 60);
}

TEST_CASE("certificate: a constant off-diagonal has its spectrum by hand", "[stability]") {
    Random random(201);
    for (const Index n : {2, 3, 8, 40, 150}) {
        for (const double hair : hairs) {
            // Off-diagonal −1: the least eigenvalue is diagonal − (n − 1). Off-diagonal 1: d − 1.
            const auto degree = static_cast<double>(n - 1);
            const double below = std::nextafter(degree * (1 - hair), 0);
            check_refused(random, constant_off_diagonal(n, below, -1));
            if (n > 2)
                check_refused(random, constant_off_diagonal(n, std::nextafter(1 - hair, 0), 1));
            CHECK(proves_positive_definite(constant_off_diagonal(n, 1.001 * degree, -1)).proved);
        }
        // Singular is not definite either.
        check_refused(random, constant_off_diagonal(n, static_cast<double>(n - 1), -1));
        if (n > 2) check_refused(random, constant_off_diagonal(n, 1, 1));
    }
}

TEST_CASE("certificate: random sparse, arrow and tridiagonal matrices a hair below definite",
          "[stability][slow]") {
    Random random(202);
    int tested = 0;
    for (int repeat = 0; repeat < 250; ++repeat) {
        const Index n = 3 + random.below(28);
        Eigen::MatrixXd A = random_graph(random, n, 2 + random.below(5));
        if (repeat % 3 == 1) {  // an arrow
            const Eigen::VectorXd border = random_vector(random, n);
            A = Eigen::MatrixXd(A.diagonal().asDiagonal());
            A.col(n - 1) += border;
            A.row(n - 1) += border.transpose();
        } else if (repeat % 3 == 2) {  // tridiagonal
            for (Index i = 0; i < n; ++i) {
                for (Index j = 0; j < n; ++j) {
                    if (std::abs(i - j) > 1) A(i, j) = 0;
                    if (std::abs(i - j) == 1) A(i, j) = 0.5 * std::sqrt(A(i, i) * A(j, j));
                }
            }
            A = (0.5 * (A + A.transpose())).eval();
        }
        for (const double hair : hairs) {
            Eigen::MatrixXd below = A;
            if (!make_indefinite(below, hair)) continue;
            ++tested;
            INFO("matrix " << repeat << ", " << hair);
            check_refused(random, below.sparseView());
        }
    }
    CHECK(tested > 1500);
}

TEST_CASE("certificate: rotated spectra with one eigenvalue a hair below zero",
          "[stability][slow]") {
    Random random(203);
    int tested = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
        const Index n = 2 + random.below(15);
        RealMatrix G(n, n);
        for (Index i = 0; i < n * n; ++i) G.data()[i] = random.uniform(-1, 1);
        const RealMatrix Q = orthogonal(G);
        const double condition = over_decades(random, 3);
        RealVector lambda(n);
        for (Index i = 0; i < n; ++i)
            lambda[i] = static_cast<Real>(log_uniform(random, 1 / (1 + condition), 1));
        for (const double hair : hairs) {
            lambda[0] = -static_cast<Real>(hair);
            const RealMatrix rotated = Q * lambda.asDiagonal() * Q.transpose();
            Eigen::MatrixXd A = rotated.cast<double>();
            A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
            // Rounding to double may have lifted it.
            if (!(eigenvalues(A.cast<Real>())[0] < -1e-17L)) continue;
            ++tested;
            INFO("matrix " << repeat << ", " << hair);
            check_refused(random, A.sparseView());
        }
    }
    CHECK(tested > 1200);
}

TEST_CASE("certificate: what is proved is definite, at any distance from singular", "[stability]") {
    Random random(204);
    int proved = 0;
    int refused = 0;
    for (int repeat = 0; repeat < 600; ++repeat) {
        const Index n = 2 + random.below(12);
        Eigen::VectorXd lambda(n);
        for (Index i = 0; i < n; ++i) lambda[i] = log_uniform(random, 0.1, 1);
        lambda[0] = (random.below(2) == 0 ? 1 : -1) * log_uniform(random, 1e-18, 1e-12);
        const Eigen::MatrixXd A = with_spectrum(random, lambda);
        const auto proof = proves_positive_definite(A.sparseView());
        if (proof.proved) {
            CHECK(eigenvalues(A.cast<Real>())[0] > 0);
            CHECK(proof.least_pivot > 0);
            CHECK(proof.shift > 0);
        }
        ++(proof.proved ? proved : refused);
    }
    CHECK(proved > 50);
    CHECK(refused > 300);
}

TEST_CASE("certificate: well-conditioned matrices are proved, whatever their scale",
          "[stability]") {
    Random random(205);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const Index n = 1 + random.below(30);
        Eigen::VectorXd lambda(n);
        for (Index i = 0; i < n; ++i) lambda[i] = log_uniform(random, 1e-8, 1);
        const Sparse A = with_spectrum(random, lambda).sparseView();
        const auto proof = proves_positive_definite(A);
        CHECK(proof.proved);
        CHECK(proof.shift < 1e-11);
        CHECK(proof.least_pivot > 0);
        // The scale plays no part, not even of each row by itself.
        CHECK(proves_positive_definite(badly_scaled(random, A, 200)).proved);
    }
    for (const auto& [p, q] : {std::pair<Index, Index>{5000, 1}, {60, 60}}) {
        const double critical = static_cast<double>(-grid_least(p, q, 0));
        CHECK(proves_positive_definite(grid(p, q, critical * (1 + 1e-8))).proved);
    }
    // Denormal and huge numbers.
    for (const double size : {1e-290, 1e-150, 1e150, 1e290}) {
        CHECK(proves_positive_definite(Sparse(size * grid(7, 6, 4.5))).proved);
        CHECK_FALSE(proves_positive_definite(Sparse(size * grid(7, 6, 3))).proved);
    }
}

TEST_CASE(
    "certificate: diagonals that are not positive and finite, and entries that are no numbers",
    "[stability]") {
    const double nan = std::nan("");
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinite, -infinite, 0.0, -0.0, -1.0, -1e-300}) {
        for (const Index where : {0, 4, 8}) {
            Eigen::MatrixXd A(grid(3, 3, 5));
            A(where, where) = bad;
            CHECK_FALSE(proves_positive_definite(A.sparseView(1, 0)).proved);
        }
    }
    for (const double bad : {nan, infinite, -infinite, 1e300}) {
        for (const Index where : {0, 3, 7}) {
            Eigen::MatrixXd A(grid(3, 3, 5));
            A(where, where + 1) = A(where + 1, where) = bad;
            CHECK_FALSE(proves_positive_definite(A.sparseView(1, 0)).proved);
        }
    }
    // A missing diagonal entry is a zero.
    Sparse hollow(2, 2);
    hollow.insert(0, 1) = hollow.insert(1, 0) = 1;
    CHECK_FALSE(proves_positive_definite(hollow).proved);
}

TEST_CASE("certificate: the errors of forming a matrix count", "[stability]") {
    Random random(206);
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Index n = 2 + random.below(10);
        Eigen::VectorXd lambda = Eigen::VectorXd::Ones(n);
        lambda[0] = log_uniform(random, 1e-6, 1e-2);
        const Sparse A = with_spectrum(random, lambda).sparseView();
        taut::Prover prover;
        // Scaling to a diagonal near one moves the least eigenvalue by a bounded factor.
        const auto with_error = [&](double error) {
            return prover(Sparse(A),
                          [&](const Eigen::VectorXd& s) {
                              REQUIRE(s.size() == n);
                              const Eigen::VectorXd diagonal =
                                  s.cwiseProduct(s).cwiseProduct(Eigen::VectorXd(A.diagonal()));
                              REQUIRE(diagonal.minCoeff() > 0.49);
                              REQUIRE(diagonal.maxCoeff() < 2.01);
                              return error;
                          })
                .proved;
        };
        CHECK(with_error(0));
        CHECK(with_error(1e-3 * lambda[0]));
        CHECK_FALSE(with_error(1e3 * lambda[0]));
        CHECK_FALSE(with_error(std::nan("")));
        CHECK_FALSE(with_error(std::numeric_limits<double>::infinity()));
        // A failure leaves the prover fit for the next matrix of the same pattern.
        CHECK(with_error(0));
        CHECK(prover.factorizations() >= 3);
    }
}

TEST_CASE("certificate: its allowance for rounding is that of the theory, and little more",
          "[stability]") {
    const Real u = std::numeric_limits<double>::epsilon() / 2;
    const auto share = [&](Index q) {  // [T22] in long double
        const Real gamma = static_cast<Real>(q + 1) * u / (1 - static_cast<Real>(q + 1) * u);
        return gamma / (1 - gamma);
    };
    for (const Index q : {1, 2, 3, 7, 30, 1000, 30000, 1000000, 100000000}) {
        INFO(q << " in the widest row");
        const Real computed = taut::stability_detail::cholesky_rounding(q);
        CHECK(computed >= share(q));
        CHECK(computed <= share(q + 1) * (1 + 2 * static_cast<Real>(q + 2) * u));
    }
    // The shift pays for the factorisation, for the errors of forming A, for the subtraction on
    // diagonals below 4 and for underflow.
    Random random(211);
    for (const auto& [p, q] :
         {std::pair<Index, Index>{1, 1}, {7, 1}, {5, 4}, {20, 20}, {3000, 1}}) {
        for (const double slack : {0.0, 1e-14, 1e-9, 1e-3}) {
            const Sparse A = badly_scaled(random, grid(p, q, random.uniform(4.1, 8)), 40);
            Real trace = 0;
            const auto proof = taut::Prover{}(Sparse(A), [&](const Eigen::VectorXd& s) {
                trace = 0;
                for (Index i = 0; i < A.rows(); ++i) {
                    const Real scale = s[i];
                    trace += scale * scale * static_cast<Real>(A.coeff(i, i));
                }
                return slack;
            });
            const Index widest = taut::EigenCholesky{}.analyze(A);
            const auto n = static_cast<Real>(A.rows());
            const Real eta = std::numeric_limits<double>::min();
            const Real needed = share(widest) * trace + static_cast<Real>(slack) +  //
                                2 * u + n * static_cast<Real>(widest + 1) * eta;
            INFO(p << " x " << q << ", slack " << slack);
            CHECK(static_cast<Real>(proof.shift) >= needed);
            const Real most = share(widest + 1) * trace + static_cast<Real>(slack) + 8 * u;
            CHECK(static_cast<Real>(proof.shift) <= most * (1 + 1e-10L));
            CHECK(proof.proved == (slack < 1e-2));
        }
    }
}

TEST_CASE("certificate: one analysis serves every matrix of a pattern", "[stability]") {
    taut::Prover prover;
    int proofs = 0;
    for (const double diagonal : {5.0, 3.0, 4.5, 2.0, 6.0}) {
        const auto exact = [](const Eigen::VectorXd&) { return 0.0; };
        const bool proved = prover(grid(6, 6, diagonal), exact).proved;
        CHECK(proved == (grid_least(6, 6, diagonal) > 0));
        proofs += proved ? 1 : 0;
    }
    CHECK(proofs == 3);
    CHECK(prover.factorizations() == 5);
    CHECK(prover.analyses() == 1);
}

TEMPLATE_TEST_CASE("certificate: combinations of springs are proved only where they are definite",
                   "[stability]", (std::integral_constant<int, 1>),
                   (std::integral_constant<int, 2>), (std::integral_constant<int, 3>)) {
    constexpr int Dim = TestType::value;
    Random random(207);
    int proved = 0;
    for (int repeat = 0; repeat < 150; ++repeat) {
        const auto system = wild_system<double, Dim>(random);
        const auto x = system.initial_state().x;
        const auto pencil = taut::SpringPencil<Dim>::at_pose(system, x);
        const Exact e = exact_matrices(system, x);
        const auto stiffness = random.below(2) == 0 ? matrices::K_plus : matrices::K;
        const RealVector k = exact_eigenvalues(e, stiffness);
        const auto top = static_cast<double>(k[k.size() - 1]);
        if (!(top > 0)) continue;
        taut::Prover prover;
        INFO("system " << repeat);
        for (const double hair : hairs) {
            const double sigma = top * (1 - hair);
            const taut::Combination c = sigma * matrices::M - stiffness;
            // The rounding of sigma itself, and of the long double eigenvalue.
            if (exact_eigenvalues(e, c)[0] < -1e-17L * k[k.size() - 1])
                CHECK_FALSE(taut::prove(prover, pencil, c).proved);
        }
        CHECK(taut::prove(prover, pencil, top * (1 + 1e-6) * matrices::M - stiffness).proved);
        ++proved;
        // Any other sum: a proof is never wrong.
        for (int other = 0; other < 10; ++other) {
            const auto c = wild_combination(random);
            if (taut::prove(prover, pencil, c).proved) CHECK(exact_eigenvalues(e, c)[0] > 0);
        }
    }
    CHECK(proved > 100);
}

}  // namespace taut_test::certificate_test
