// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"

// One false proof would make every certificate worthless, so most of these matrices have a least
// eigenvalue just below zero: by a closed form, by a Schur complement or by long double.

namespace taut_test::certificate_test {

namespace matrices = taut::matrices;

using taut::proves_positive_definite;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double hairs[] = {1e-16, 3e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6};

bool proved(const Sparse& A) { return proves_positive_definite(A).proved; }

/// S A S with powers of two: exact, and not a sign of an eigenvalue changes.
Sparse badly_scaled(Random& random, const Sparse& A, int range) {
    Eigen::VectorXd s(A.rows());
    for (Index i = 0; i < s.size(); ++i)
        s[i] = std::exp2(static_cast<double>(random.below(2 * range + 1) - range));
    return s.asDiagonal() * A * s.asDiagonal();
}

/// Both with the given matrix and scaled.
void check_refused(Random& random, const Sparse& A) {
    CHECK_FALSE(proved(A));
    CHECK_FALSE(proved(badly_scaled(random, A, 60)));
}

/// `diagonal` on the diagonal and −1 between neighbours of a p × q grid; eigenvalues diagonal −
/// 2cos(jπ/(p + 1)) − 2cos(lπ/(q + 1)), without the second term for q = 1.
Sparse grid(Index p, Index q, double diagonal) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; i < p * q; ++i) {
        const auto join = [&](Index other) {
            entries.emplace_back(i, other, -1);
            entries.emplace_back(other, i, -1);
        };
        entries.emplace_back(i, i, diagonal);
        if ((i + 1) % p != 0) join(i + 1);
        if (i + p < p * q) join(i + p);
    }
    Sparse A(p * q, p * q);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}
Real grid_least(Index p, Index q, double diagonal) {
    const Real pi = std::acos(Real(-1));
    const Real second = q > 1 ? 2 * std::cos(pi / static_cast<Real>(q + 1)) : Real(0);
    return static_cast<Real>(diagonal) - 2 * std::cos(pi / static_cast<Real>(p + 1)) - second;
}

Sparse constant_off_diagonal(Index n, double diagonal, double off) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Constant(n, n, off);
    A.diagonal().setConstant(diagonal);
    return A.sparseView();
}

/// A with its last diagonal entry a hair below what definiteness needs: bᵀB⁻¹b, in long double.
bool make_indefinite(Eigen::MatrixXd& A, double hair) {
    const Index n = A.rows();
    const RealMatrix B = A.cast<Real>().topLeftCorner(n - 1, n - 1);
    if (!(eigenvalues(B)[0] > 0)) return false;
    const RealMatrix b = A.cast<Real>().col(n - 1).head(n - 1);
    const Real schur = (b.transpose() * solve(B, b))(0, 0);
    if (!(schur > 0)) return false;
    A(n - 1, n - 1) = static_cast<double>(schur * (1 - static_cast<Real>(hair)));
    return static_cast<Real>(A(n - 1, n - 1)) < schur * (1 - 1e-17L);
}

}  // namespace

TEST_CASE("certificate: grids and rows a hair below definite are not proved, as far above they are",
          "[tight]") {
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
        const auto critical = static_cast<double>(-grid_least(p, q, 0));
        for (const double hair : hairs) {
            const double diagonal = critical * (1 - hair);
            // Where rounding has put the diagonal above, or on the spot.
            if (!(diagonal > 0) || !(grid_least(p, q, diagonal) < -1e-18L)) continue;
            ++tested;
            INFO(p << " x " << q << ", " << hair);
            check_refused(random, grid(p, q, diagonal));
        }
        if (p * q > 1) CHECK(proved(grid(p, q, critical * (1 + 1e-8))));
    }
    CHECK(tested > 60);
    // Denormal and huge numbers.
    for (const double size : {1e-290, 1e-150, 1e150, 1e290}) {
        CHECK(proved(Sparse(size * grid(7, 6, 4.5))));
        CHECK_FALSE(proved(Sparse(size * grid(7, 6, 3))));
    }
}

TEST_CASE("certificate: a constant off-diagonal has its spectrum by hand", "[tight]") {
    Random random(201);
    for (const Index n : {2, 3, 8, 40, 100}) {
        const auto degree = static_cast<double>(n - 1);
        for (const double hair : hairs) {
            // Off-diagonal −1: the least eigenvalue is diagonal − (n − 1). Off-diagonal 1: d − 1.
            check_refused(random,
                          constant_off_diagonal(n, std::nextafter(degree * (1 - hair), 0), -1));
            if (n > 2)
                check_refused(random, constant_off_diagonal(n, std::nextafter(1 - hair, 0), 1));
        }
        CHECK(proved(constant_off_diagonal(n, 1.001 * degree, -1)));
        // Singular is not definite either.
        check_refused(random, constant_off_diagonal(n, degree, -1));
        if (n > 2) check_refused(random, constant_off_diagonal(n, 1, 1));
    }
}

TEST_CASE("certificate: random sparse, arrow and tridiagonal matrices a hair below definite",
          "[tight]") {
    Random random(202);
    int tested = 0;
    for (int repeat = 0; repeat < 150; ++repeat) {
        const Index n = 3 + random.below(20);
        Eigen::MatrixXd A = random_graph(random, n, 2 + random.below(5));
        if (repeat % 3 == 1) {  // an arrow
            const Eigen::VectorXd border = random_vector(random, n);
            A = Eigen::MatrixXd(A.diagonal().asDiagonal());
            A.col(n - 1) += border;
            A.row(n - 1) += border.transpose();
        } else if (repeat % 3 == 2) {  // tridiagonal
            for (Index i = 0; i < n; ++i) {
                for (Index j = 0; j < i; ++j) {
                    const double next = 0.5 * std::sqrt(A(i, i) * A(j, j));
                    A(i, j) = A(j, i) = i - j > 1 ? 0 : next;
                }
            }
        }
        CHECK((repeat % 3 != 0 || proved(A.sparseView())));
        for (const double hair : hairs) {
            Eigen::MatrixXd below = A;
            if (!make_indefinite(below, hair)) continue;
            ++tested;
            INFO("matrix " << repeat << " of seed 202, " << hair);
            check_refused(random, below.sparseView());
        }
    }
    CHECK(tested > 900);
}

TEST_CASE("certificate: what is proved is definite, at any distance from singular", "[tight]") {
    Random random(204);
    int proofs = 0, refused = 0;
    for (int repeat = 0; repeat < 1200; ++repeat) {
        INFO("matrix " << repeat << " of seed 204");
        const Index n = 2 + random.below(12);
        Eigen::VectorXd lambda(n);
        const double condition = repeat % 2 == 0 ? 10 : over_decades(random, 3) + 1;
        for (Index i = 0; i < n; ++i) lambda[i] = log_uniform(random, 1 / condition, 1);
        lambda[0] = (random.below(4) == 0 ? 1 : -1) * log_uniform(random, 1e-18, 1e-12);
        const Eigen::MatrixXd A = with_spectrum(random, lambda);
        const auto proof = proves_positive_definite(A.sparseView());
        if (proof.proved) {
            CHECK(eigenvalues(A.cast<Real>())[0] > 0);
            CHECK(proof.least_pivot > 0);
            CHECK(proof.shift > 0);
        }
        ++(proof.proved ? proofs : refused);
    }
    CHECK(proofs > 50);
    CHECK(refused > 800);
}

TEST_CASE("certificate: well-conditioned matrices are proved, whatever their scale", "[tight]") {
    Random random(205);
    for (int repeat = 0; repeat < 200; ++repeat) {
        INFO("matrix " << repeat << " of seed 205");
        const Index n = 1 + random.below(30);
        Eigen::VectorXd lambda(n);
        for (Index i = 0; i < n; ++i) lambda[i] = log_uniform(random, 1e-8, 1);
        const Sparse A = with_spectrum(random, lambda).sparseView();
        const auto proof = proves_positive_definite(A);
        CHECK(proof.proved);
        CHECK(proof.shift < 1e-11);
        CHECK(proof.least_pivot > 0);
        // The scale plays no part, not even of each row by itself.
        CHECK(proved(badly_scaled(random, A, 200)));
    }
}

TEST_CASE("certificate: diagonals that are not positive and finite, entries that are no numbers",
          "[tight][bad_input]") {
    const auto refused = [](Index i, Index j, double bad) {
        Eigen::MatrixXd A(grid(3, 3, 5));
        A(i, j) = A(j, i) = bad;
        return !proved(A.sparseView(1, 0));
    };
    for (const double bad : {std::nan(""), infinite, -infinite, 0.0, -0.0, -1.0, -1e-300}) {
        for (const Index where : {0, 4, 8}) CHECK(refused(where, where, bad));
    }
    for (const double bad : {std::nan(""), infinite, -infinite, 1e300}) {
        for (const Index where : {0, 3, 7}) CHECK(refused(where, where + 1, bad));
    }
    // A missing diagonal entry is a zero.
    Sparse hollow(2, 2);
    hollow.insert(0, 1) = hollow.insert(1, 0) = 1;
    CHECK_FALSE(proved(hollow));
}

TEST_CASE("certificate: the errors of forming a matrix count", "[tight]") {
    Random random(206);
    for (int repeat = 0; repeat < 50; ++repeat) {
        INFO("matrix " << repeat << " of seed 206");
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
        for (const double error : {1e3 * lambda[0], std::nan(""), infinite})
            CHECK_FALSE(with_error(error));
        // A failure leaves the prover fit for the next matrix of the same pattern.
        CHECK(with_error(0));
        CHECK(prover.factorizations() >= 3);
        CHECK(prover.analyses() == 1);
    }
}

TEST_CASE("certificate: its allowance for rounding is that of the theory, and little more",
          "[tight]") {
    const Real u = std::numeric_limits<double>::epsilon();  // of rounding in any direction
    const auto share = [&](Index q) {                       // [T22] in long double
        const Real gamma = static_cast<Real>(q + 1) * u / (1 - static_cast<Real>(q + 1) * u);
        return gamma / (1 - gamma);
    };
    for (const Index q : {1, 2, 3, 7, 30, 1000, 30000, 1000000, 100000000}) {
        INFO(q << " in the widest row");
        const Real computed = taut::proof_detail::cholesky_rounding(q);
        CHECK(computed >= share(q));
        CHECK(computed <= share(q + 1) * (1 + 2 * static_cast<Real>(q + 2) * u));
    }
    // The shift pays for the factorisation, for the errors of forming A, for the subtraction on
    // diagonals below 4 and for underflow.
    Random random(211);
    for (const auto& [p, q] : {std::pair<Index, Index>{1, 1}, {7, 1}, {20, 20}, {3000, 1}}) {
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
            CHECK(proof.proved);
        }
    }
}

TEST_CASE("certificate: combinations of springs are proved only where they are definite",
          "[tight]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Random random(207);
        int tested = 0;
        for (int repeat = 0; repeat < 100; ++repeat) {
            INFO(kind << ", system " << repeat << " of seed 207");
            const auto scene = wild_scene(random, kind);
            const auto state = scene.initial_state();
            const Analysis analysis(scene, state);
            const auto& pencil = analysis.pencil();
            const Exact e = exact_matrices(scene, state.x);
            const auto stiffness = random.below(2) == 0 ? matrices::K_plus : matrices::K;
            const RealVector k = exact_eigenvalues(e, stiffness);
            const auto top = static_cast<double>(k[k.size() - 1]);
            if (!(top > 0)) continue;
            taut::Prover prover;
            for (const double hair : hairs) {
                const taut::Combination c = top * (1 - hair) * matrices::M - stiffness;
                // The rounding of the factor itself, and of the long double eigenvalue.
                if (exact_eigenvalues(e, c)[0] < -1e-17L * k[k.size() - 1])
                    CHECK_FALSE(taut::prove(prover, pencil, c).proved);
            }
            CHECK(taut::prove(prover, pencil, top * (1 + 1e-6) * matrices::M - stiffness).proved);
            ++tested;
            // Any other sum: a proof is never wrong.
            for (int other = 0; other < 10; ++other) {
                const auto c = wild_combination(random);
                if (taut::prove(prover, pencil, c).proved) CHECK(exact_eigenvalues(e, c)[0] > 0);
            }
        }
        CHECK(tested > 60);
    }
}

}  // namespace taut_test::certificate_test
