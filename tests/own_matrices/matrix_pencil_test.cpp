// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/proof/bracket.hpp>
#include <taut/proof/pencil_matrix.hpp>

#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"
#include "matrices.hpp"

namespace taut_test::own_matrices {

namespace matrices = taut::matrices;

using taut::Combination;

namespace {

/// Sparse, symmetric, entries of both signs over decades.
RealMatrix wild_matrix(Random& random, Index n) {
    RealMatrix A = RealMatrix::Zero(n, n);
    for (Index e = 0; e < 2 * n; ++e) {
        const Index i = random.below(n), j = random.below(n);
        A(i, j) = A(j, i) = (random.below(3) == 0 ? -1 : 1) * over_decades(random, 3);
    }
    return A;
}
Matrices wild_matrices(Random& random, Digits digits = Digits::of_double) {
    const Index n = 1 + random.below(14);
    RealVector mass(n);
    for (Index i = 0; i < n; ++i) mass[i] = over_decades(random, 3);
    const RealMatrix K = wild_matrix(random, n);
    return {mass, random.below(3) > 0 ? wild_matrix(random, n) : RealMatrix(0 * K), K, digits};
}

RealVector log_uniforms(Random& random, Index n, double low, double high) {
    RealVector v(n);
    for (Index i = 0; i < n; ++i) v[i] = log_uniform(random, low, high);
    return v;
}

}  // namespace

TEST_CASE("matrix_pencil: upper_bound is never below the largest eigenvalue", "[own_matrices]") {
    for (const Digits digits : {Digits::of_float, Digits::of_double}) {
        Random random(900);
        for (int repeat = 0; repeat < 1500; ++repeat) {
            const auto system = wild_matrices(random, digits);
            const auto pencil = pencil_of(system);
            for (int other = 0; other < 3; ++other) {
                const Combination c = other == 0 ? matrices::K_plus : wild_combination(random);
                const RealVector all = exact_eigenvalues(system.exact(), c);
                const Real noise = 64 * real_epsilon * all.cwiseAbs().maxCoeff();
                CAPTURE(static_cast<int>(digits), repeat, c.mass(), c.stiffness() + c.projected(),
                        c.damping());
                const double bound = pencil->upper_bound(c);
                CHECK(bound >= all[all.size() - 1] - noise);
            }
        }
    }
}

TEST_CASE("matrix_pencil: the bound counts what is left where terms cancel", "[own_matrices]") {
    Random random(907);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const double k = 1 / random.uniform(1, 2), b = 1 / random.uniform(1, 2), a = b * k;
        const auto pencil = pencil_of({RealVector::Ones(1), {}, RealMatrix::Constant(1, 1, k)});
        INFO("repeat " << repeat);
        CHECK(pencil->upper_bound(a * matrices::M - b * matrices::K_plus) >= a - Real(b) * k);
    }
}

TEST_CASE("matrix_pencil: masses at both ends of the range leave no bound too low",
          "[own_matrices]") {
    // Weights of the bound vanish there; K_ii/m_i is below the largest eigenvalue whatever they
    // are.
    Random random(905);
    int bounded = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
        const Index n = 2 + random.below(8);
        const RealVector mass = log_uniforms(random, n, 1e-280, 1e60);
        RealMatrix K = RealMatrix::Zero(n, n);
        for (Index spring = 0; spring < 2 * n; ++spring) {
            const Index a = random.below(n), b = random.below(n);
            const double k = log_uniform(random, 1e-6, 1e9);
            K(a, a) += k;
            if (a == b) continue;
            K(b, b) += k;
            K(a, b) -= k;
            K(b, a) -= k;
        }
        const Matrices m(mass, {}, K);
        const double bound = pencil_of(m)->upper_bound(matrices::K_plus);
        INFO("repeat " << repeat);
        CHECK(bound >=
              m.K.diagonal().cast<double>().cwiseQuotient(m.mass.cast<double>()).maxCoeff());
        bounded += std::isfinite(bound);
    }
    CHECK(bounded > 100);
}

TEST_CASE("matrix_pencil: the bound is sharp where no sign cancels", "[own_matrices]") {
    // Collatz and Wielandt: for entries ≥ 0, and for a row of springs, it converges to the truth.
    Random random(901);
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Index n = 2 + random.below(10);
        RealMatrix A(n, n);
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j <= i; ++j) A(i, j) = A(j, i) = random.uniform(0.1, 1);
        const Matrices m(log_uniforms(random, n, 0.3, 3), {}, A);
        CHECK_THAT(
            pencil_of(m)->upper_bound(matrices::K_plus),
            WithinRel(static_cast<double>(exact_eigenvalues(m.exact(), matrices::K_plus)[n - 1]),
                      1e-6));
    }
    RealMatrix row = 2 * RealMatrix::Identity(6, 6);
    row.diagonal(1).setConstant(-1);
    row.diagonal(-1).setConstant(-1);
    CHECK_THAT(pencil_of({RealVector::Ones(6), {}, row})->upper_bound(matrices::K_plus),
               WithinRel(static_cast<double>(eigenvalues(row)[5]), 0.01));
}

TEST_CASE("matrix_pencil: multiply, quadratic, assemble and their errors", "[own_matrices]") {
    Random random(902);
    for (int repeat = 0; repeat < 500; ++repeat) {
        const auto m = wild_matrices(random);
        const auto pencil = pencil_of(m);
        const Combination c = wild_combination(random);
        const Real on_K = c.stiffness() + c.projected();
        const RealMatrix exact = exact_sum(m.exact(), c);
        RealMatrix sizes = std::abs(on_K) * m.K.cwiseAbs() + std::abs(c.damping()) * m.D.cwiseAbs();
        sizes.diagonal() += std::abs(c.mass()) * m.mass;
        INFO("repeat " << repeat);

        const Eigen::MatrixXd S(pencil->assemble(c));
        CHECK((S == S.transpose()));
        RealVector s(pencil->size());
        for (Index i = 0; i < s.size(); ++i) s[i] = over_decades(random, 4);
        const RealMatrix E = (S.cast<Real>() - exact).cwiseAbs();
        CHECK(s.cwiseProduct(E * s).maxCoeff() <= pencil->assembly_error(c, s.cast<double>()));

        const Eigen::VectorXd u =
            s.cast<double>().cwiseProduct(random_vector(random, pencil->size()));
        const RealVector v = u.cast<Real>(), magnitude = sizes * v.cwiseAbs();
        const auto q = pencil->quadratic(c, u);
        CHECK(std::abs(v.dot(exact * v) - q.value) <=
              q.error + 64 * real_epsilon * v.cwiseAbs().dot(magnitude));
        Eigen::VectorXd y;
        pencil->multiply(c, u, y);
        const RealVector error = (y.cast<Real>() - exact * v).cwiseAbs();
        CHECK((error.array() <= 64 * 0x1p-52L * magnitude.array()).all());
    }
}

TEST_CASE("matrix_pencil: what is called semi-definite or Rayleigh is so", "[own_matrices]") {
    Random random(903);
    int claimed = 0;
    for (int repeat = 0; repeat < 600; ++repeat) {
        const Index n = 1 + random.below(10);
        RealVector k = log_uniforms(random, n, 1e-3, 1), d = log_uniforms(random, n, 1e-3, 1);
        const double hair = (random.below(2) == 0 ? 1 : -1) * log_uniform(random, 1e-17, 1e-3);
        if (repeat % 2 == 0) k[0] = hair;
        if (repeat % 3 == 0) d[0] = hair;
        const auto with = [&](const RealVector& spectrum) -> RealMatrix {
            return with_spectrum(random, spectrum.cast<double>()).cast<Real>();
        };
        const RealMatrix D = with(d), K = with(k);
        const Matrices m(log_uniforms(random, n, 0.1, 10), D, K);
        const auto pencil = pencil_of(m);
        INFO("repeat " << repeat);
        if (pencil->stiffness_semidefinite()) CHECK(eigenvalues(m.K)[0] >= -1e-18L);
        if (pencil->damping_semidefinite()) CHECK(eigenvalues(m.D)[0] >= -1e-18L);
        claimed += pencil->stiffness_semidefinite() ? 1 : 0;
        if (repeat % 2 == 1) CHECK(pencil->stiffness_semidefinite());
        CHECK((n == 1 || !pencil->is_rayleigh()));
        CHECK(pencil->projected_semidefinite() == pencil->stiffness_semidefinite());
        CHECK(pencil->resolution() == 0);
    }
    CHECK(claimed > 300);
}

TEST_CASE("matrix_pencil: diagonal dominance needs no factorisation, and is not rounded",
          "[own_matrices]") {
    const auto semidefinite = [](const RealMatrix& K) {
        return pencil_of({RealVector::Ones(K.rows()), {}, K})->stiffness_semidefinite();
    };
    // Three masses in a ring: K is singular, so only dominance can show it semi-definite. One ulp
    // less is indefinite.
    RealMatrix ring{{2, -1, -1}, {-1, 2, -1}, {-1, -1, 2}};
    CHECK(semidefinite(ring / 10));
    for (const double less : {0x1p-52, 0x1p-53, 1e-12}) {
        ring(2, 2) = 2 - 2 * less;
        REQUIRE(eigenvalues(ring)[0] < 0);
        CHECK_FALSE(semidefinite(ring));
    }
    // A row whose sum rounds down to the diagonal: 1 + 2^-53 + 2^-53 in this order gives 1.
    RealMatrix K = RealMatrix::Identity(4, 4);
    K(0, 1) = K(1, 0) = 1;
    K(0, 2) = K(2, 0) = K(0, 3) = K(3, 0) = 0x1p-53;
    CHECK_FALSE(semidefinite(K));
}

TEST_CASE("matrix_pencil: every entry of D says whether it is d0*M", "[own_matrices]") {
    for (const Digits digits : {Digits::of_double, Digits::of_long_double}) {
        Random random(906);
        const auto damped = [&](const RealVector& mass, const RealVector& damping) {
            const RealMatrix D = damping.asDiagonal(), K = mass.asDiagonal();
            return pencil_of({mass, D, K, digits});
        };
        for (int repeat = 0; repeat < 1000; ++repeat) {
            const Index n = 2 + random.below(6);
            RealVector mass(n);
            for (Index i = 0; i < n; ++i) {
                // More digits than Random's.
                const double more = random.uniform(1, 2) + random.uniform(0, 1) * 0x1p-30;
                mass[i] = log_uniform(random, 1e-70, 1e70) * more;
            }
            const Real d0 = log_uniform(random, 1e-70, 1e70) * random.uniform(1, 2) / 3;
            RealVector damping = d0 * mass;
            INFO("repeat " << repeat);
            const auto pencil = damped(mass, damping);
            CHECK(pencil->is_rayleigh());
            CHECK(pencil->damping_semidefinite());
            CHECK_THAT(pencil->rayleigh().mass_proportional,
                       WithinRel(static_cast<double>(d0), 1e-15));
            // Negative damping is no Rayleigh damping.
            const auto negative = damped(mass, -damping);
            CHECK_FALSE(negative->is_rayleigh());
            CHECK_FALSE(negative->damping_semidefinite());
            // Any one of them may deny it.
            const Index other = random.below(n);
            damping[other] *= 1 + 1e-14;
            CHECK_FALSE(damped(mass, damping)->is_rayleigh());
            damping[other] = 0;
            CHECK_FALSE(damped(mass, damping)->is_rayleigh());
        }
        // Where d0·m, or an entry over m, would vanish, the entry is out of range already.
        for (int repeat = 0; repeat < 100; ++repeat) {
            const Real tiny = log_uniform(random, 1e-300, 1e-170);
            const Real small = log_uniform(random, 1e-300, 1e-170);
            CHECK_FALSE(damped(RealVector{{1, small}}, RealVector{{tiny, 0}})->lost().empty());
            CHECK_FALSE(damped(RealVector{{1, 1 / small}}, RealVector{{0, tiny}})->lost().empty());
        }
        const auto half = damped(RealVector{{1, 2, 4}}, RealVector{{0.5, 1, 2}});
        CHECK(half->is_rayleigh());
        CHECK(half->rayleigh().mass_proportional == 0.5);
        const auto none = damped(RealVector::Ones(3), RealVector::Zero(3));
        CHECK(none->is_rayleigh());
        CHECK(none->rayleigh().mass_proportional == 0);
    }
}

TEST_CASE("matrix_pencil: scaled() and shares", "[own_matrices]") {
    Random random(905);
    for (int repeat = 0; repeat < 200; ++repeat) {
        auto m = wild_matrices(random);
        if (repeat % 4 == 0) m.D = RealMatrix(m.mass.asDiagonal());
        const auto pencil = pencil_of(m);
        const double stiffness = over_decades(random, 2), mass = over_decades(random, 2);
        const auto scaled = pencil->scaled(stiffness, mass);
        INFO("repeat " << repeat);
        CHECK((scaled.mass() == mass * m.mass.cast<double>()));
        CHECK((pencil->mass() == m.mass.cast<double>()));
        const auto check = [&](const Combination& c, const RealMatrix& expected) {
            const Eigen::MatrixXd error = scaled.assemble(c) - expected.cast<double>();
            CHECK(error.cwiseAbs().maxCoeff() <= 64 * 0x1p-52L * expected.cwiseAbs().maxCoeff());
        };
        check(matrices::K_plus, stiffness * m.K);
        check(matrices::D, (pencil->is_rayleigh() ? mass : 1) * m.D);

        const auto u = random_vector(random, pencil->size());
        CHECK(pencil->spring_shares(u).empty());
        double sum = 0;
        for (const auto& share : pencil->particle_shares(u)) sum += share.share;
        CHECK_THAT(sum, WithinAbs(1.0, 64 * 0x1p-52));
        CHECK(static_cast<Index>(pencil->particle_shares(u).size()) == pencil->size());
    }
}

}  // namespace taut_test::own_matrices
