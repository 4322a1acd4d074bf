// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/matrix_pencil.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "../stability/wild_system.hpp"

namespace taut_test::matrix_pencil_test {

namespace matrices = taut::matrices;

using taut::Combination;
using taut::LinearSystem;
using taut::MatrixPencil;

namespace {

/// Sparse, symmetric, entries of both signs over decades.
Eigen::MatrixXd wild_matrix(Random& random, Index n, double decades) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    for (Index e = 0; e < 2 * n; ++e) {
        const Index i = random.below(n);
        const Index j = random.below(n);
        A(i, j) = A(j, i) = (random.below(3) == 0 ? -1 : 1) * over_decades(random, decades);
    }
    return A;
}

template <class Scalar = double>
LinearSystem<Scalar> wild_matrices(Random& random) {
    const Index n = 1 + random.below(14);
    taut::VectorX<Scalar> mass(n);
    for (Index i = 0; i < n; ++i) mass[i] = static_cast<Scalar>(over_decades(random, 3));
    const Eigen::MatrixXd K = wild_matrix(random, n, 3);
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
    if (random.below(3) > 0) D = wild_matrix(random, n, 3);
    return {mass, sparse<Scalar>(D), sparse<Scalar>(K)};
}

}  // namespace

TEMPLATE_TEST_CASE("matrix_pencil: upper_bound is never below the largest eigenvalue",
                   "[stability]", double, float) {
    Random random(900);
    for (int repeat = 0; repeat < 1500; ++repeat) {
        const auto system = wild_matrices<TestType>(random);
        const MatrixPencil pencil(system);
        const Exact e = exact_matrices(system);
        for (int other = 0; other < 3; ++other) {
            const Combination c = other == 0 ? matrices::K_plus : wild_combination(random);
            const RealVector all = exact_eigenvalues(e, c);
            const Real noise = 64 * real_epsilon * all.cwiseAbs().maxCoeff();
            INFO("system " << repeat << ", weights " << c.mass() << ", "
                           << c.stiffness() + c.projected() << ", " << c.damping());
            const double bound = pencil.upper_bound(c);
            CHECK(static_cast<Real>(bound) >= all[all.size() - 1] - noise);
            CHECK(static_cast<Real>(pencil.upper_bound(c, 2 * std::abs(bound))) >=
                  all[all.size() - 1] - noise);
        }
    }
}

TEST_CASE("matrix_pencil: masses at both ends of the range leave no bound too low", "[stability]") {
    // Weights of the bound vanish there; K_ii/m_i is below the largest eigenvalue whatever they
    // are.
    Random random(905);
    int bounded = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
        const Index n = 2 + random.below(8);
        Eigen::VectorXd mass(n);
        for (Index i = 0; i < n; ++i) mass[i] = log_uniform(random, 1e-280, 1e60);
        Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
        for (Index spring = 0; spring < 2 * n; ++spring) {
            const Index a = random.below(n);
            const Index b = random.below(n);
            const double k = log_uniform(random, 1e-6, 1e9);
            K(a, a) += k;
            if (a == b) continue;
            K(b, b) += k;
            K(a, b) -= k;
            K(b, a) -= k;
        }
        const MatrixPencil pencil(LinearSystem<double>(mass, {}, sparse(K)));
        const double bound = pencil.upper_bound(matrices::K_plus);
        CHECK(bound >= K.diagonal().cwiseQuotient(mass).maxCoeff());
        bounded += std::isfinite(bound);
    }
    CHECK(bounded > 100);
}

TEMPLATE_TEST_CASE("matrix_pencil: every entry of D says whether it is d0*M", "[stability]", double,
                   long double) {
    Random random(906);
    const auto pencil_of = [](const taut::VectorX<TestType>& mass,
                              const taut::VectorX<TestType>& damping) {
        taut::SparseMatrix<TestType> D(mass.size(), mass.size());
        taut::SparseMatrix<TestType> K(mass.size(), mass.size());
        for (Index i = 0; i < mass.size(); ++i) {
            if (damping[i] != 0) D.insert(i, i) = damping[i];
            K.insert(i, i) = mass[i];
        }
        return MatrixPencil(LinearSystem<TestType>(mass, D, K));
    };
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const Index n = 2 + random.below(6);
        taut::VectorX<TestType> mass(n);
        for (Index i = 0; i < n; ++i) {
            // More digits than Random's.
            const double digits = random.uniform(1, 2) + random.uniform(0, 1) * 0x1p-30;
            mass[i] = static_cast<TestType>(log_uniform(random, 1e-70, 1e70) * digits);
        }
        const auto d0 =
            static_cast<TestType>(log_uniform(random, 1e-70, 1e70) * random.uniform(1, 2) / 3);
        taut::VectorX<TestType> damping = d0 * mass;
        const auto pencil = pencil_of(mass, damping);
        CHECK(pencil.is_rayleigh());
        CHECK(pencil.damping_semidefinite());
        CHECK_THAT(pencil.rayleigh().mass_proportional, WithinRel(static_cast<double>(d0), 1e-15));
        // Any one of them may deny it.
        const Index other = random.below(n);
        damping[other] *= static_cast<TestType>(1 + 1e-14);
        CHECK_FALSE(pencil_of(mass, damping).is_rayleigh());
        damping[other] = 0;
        CHECK_FALSE(pencil_of(mass, damping).is_rayleigh());
    }
    // Where d0·m, or an entry over m, would vanish, the entry is out of range already.
    for (int repeat = 0; repeat < 100; ++repeat) {
        const auto tiny = static_cast<TestType>(log_uniform(random, 1e-300, 1e-170));
        const auto small = static_cast<TestType>(log_uniform(random, 1e-300, 1e-170));
        taut::VectorX<TestType> mass(2);
        taut::VectorX<TestType> damping(2);
        mass << 1, small;
        damping << tiny, 0;
        CHECK_FALSE(pencil_of(mass, damping).lost().empty());
        mass << 1, 1 / small;
        damping << 0, tiny;
        CHECK_FALSE(pencil_of(mass, damping).lost().empty());
    }
    CHECK(pencil_of(taut::VectorX<TestType>::Ones(3), taut::VectorX<TestType>::Zero(3))
              .is_rayleigh());
}

TEST_CASE("matrix_pencil: the bound is sharp where no sign cancels", "[stability]") {
    // Collatz and Wielandt: for entries ≥ 0, and for a row of springs, it converges to the truth.
    Random random(901);
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Index n = 2 + random.below(10);
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd mass(n);
        for (Index i = 0; i < n; ++i) {
            mass[i] = log_uniform(random, 0.3, 3);
            for (Index j = 0; j <= i; ++j) A(i, j) = A(j, i) = random.uniform(0.1, 1);
        }
        const LinearSystem<double> system(mass, {}, sparse(A));
        const RealVector k = exact_eigenvalues(exact_matrices(system), matrices::K_plus);
        CHECK_THAT(MatrixPencil(system).upper_bound(matrices::K_plus),
                   WithinRel(static_cast<double>(k[n - 1]), 1e-6));
    }
    taut::ChainOptions row;
    row.masses = 6;
    const auto chain = taut::chain<double, 1>(row);
    const auto system = taut::linearize(chain, chain.initial_state());
    const RealVector k = exact_eigenvalues(exact_matrices(system), matrices::K_plus);
    CHECK_THAT(MatrixPencil(system).upper_bound(matrices::K_plus),
               WithinRel(static_cast<double>(k[5]), 0.01));
}

TEST_CASE("matrix_pencil: multiply, quadratic, assemble and their errors", "[stability]") {
    Random random(902);
    for (int repeat = 0; repeat < 500; ++repeat) {
        const auto system = wild_matrices(random);
        const MatrixPencil pencil(system);
        const Exact e = exact_matrices(system);
        const Combination c = wild_combination(random);
        const RealMatrix exact = exact_sum(e, c);
        const Eigen::MatrixXd S(pencil.assemble(c));
        CHECK((S == S.transpose()));
        Eigen::VectorXd s(pencil.size());
        for (Index i = 0; i < s.size(); ++i) s[i] = over_decades(random, 4);
        const RealMatrix E = (S.cast<Real>() - exact).cwiseAbs();
        CHECK(s.cast<Real>().cwiseProduct(E * s.cast<Real>()).maxCoeff() <=
              static_cast<Real>(pencil.assembly_error(c, s)));

        const Eigen::VectorXd u = s.cwiseProduct(random_vector(random, pencil.size()));
        const RealVector v = u.cast<Real>();
        RealMatrix sizes =
            std::abs(static_cast<Real>(c.stiffness() + c.projected())) * e.K.cwiseAbs() +
            std::abs(static_cast<Real>(c.damping())) * e.D.cwiseAbs();
        sizes.diagonal() += std::abs(static_cast<Real>(c.mass())) * e.mass;
        const auto q = pencil.quadratic(c, u);
        CHECK(std::abs(v.dot(exact * v) - static_cast<Real>(q.value)) <=
              static_cast<Real>(q.error) +
                  64 * real_epsilon * v.cwiseAbs().dot(sizes * v.cwiseAbs()));
        Eigen::VectorXd y;
        pencil.multiply(c, u, y);
        const RealVector magnitude = sizes * v.cwiseAbs();
        for (Index i = 0; i < y.size(); ++i) {
            CHECK(std::abs(static_cast<Real>(y[i]) - exact.row(i).dot(v)) <=
                  static_cast<Real>(Tolerance<double>::rounding) * magnitude[i]);
        }
    }
}

TEST_CASE("matrix_pencil: what is called semi-definite or Rayleigh is so", "[stability]") {
    Random random(903);
    int claimed = 0;
    for (int repeat = 0; repeat < 600; ++repeat) {
        const Index n = 1 + random.below(10);
        Eigen::VectorXd k(n), d(n), mass(n);
        for (Index i = 0; i < n; ++i) {
            k[i] = log_uniform(random, 1e-3, 1);
            d[i] = log_uniform(random, 1e-3, 1);
            mass[i] = log_uniform(random, 0.1, 10);
        }
        const double hair = (random.below(2) == 0 ? 1 : -1) * log_uniform(random, 1e-17, 1e-3);
        if (repeat % 2 == 0) k[0] = hair;
        if (repeat % 3 == 0) d[0] = hair;
        const LinearSystem<double> system(mass, sparse(with_spectrum(random, d)),
                                          sparse(with_spectrum(random, k)));
        const MatrixPencil pencil(system);
        const Exact e = exact_matrices(system);
        if (pencil.stiffness_semidefinite()) CHECK(eigenvalues(e.K)[0] >= -1e-18L);
        if (pencil.damping_semidefinite()) CHECK(eigenvalues(e.D)[0] >= -1e-18L);
        claimed += pencil.stiffness_semidefinite() ? 1 : 0;
        if (repeat % 2 == 1) CHECK(pencil.stiffness_semidefinite());
        CHECK((n == 1 || !pencil.is_rayleigh()));
        CHECK(pencil.projected_semidefinite() == pencil.stiffness_semidefinite());
        CHECK(pencil.resolution() == 0);
    }
    CHECK(claimed > 300);
}

TEST_CASE("matrix_pencil: diagonal dominance needs no factorisation, and is not rounded",
          "[stability]") {
    // A free chain is singular: only dominance can show it semi-definite.
    taut::ChainOptions options;
    options.ends = taut::ChainEnds::free_free;
    options.stiffness = 0.1;
    const auto chain = taut::chain<double, 1>(options);
    CHECK(MatrixPencil(taut::linearize(chain, chain.initial_state())).stiffness_semidefinite());
    // One ulp less is indefinite.
    for (const double less : {0x1p-52, 0x1p-53, 1e-12}) {
        Eigen::Matrix3d K;
        K << 2, -1, -1, -1, 2, -1, -1, -1, 2 - 2 * less;
        const LinearSystem<double> system(Eigen::Vector3d(1, 1, 1), {}, sparse(K));
        REQUIRE(eigenvalues(K.cast<Real>())[0] < 0);
        CHECK_FALSE(MatrixPencil(system).stiffness_semidefinite());
    }
    // A row whose sum rounds down to the diagonal: 1 + 2^-53 + 2^-53 in this order gives 1.
    Eigen::Matrix4d K = Eigen::Matrix4d::Identity();
    K(0, 1) = K(1, 0) = 1;
    K(0, 2) = K(2, 0) = K(0, 3) = K(3, 0) = 0x1p-53;
    const LinearSystem<double> system(Eigen::Vector4d(1, 1, 1, 1), {}, sparse(K));
    CHECK_FALSE(MatrixPencil(system).stiffness_semidefinite());
}

TEST_CASE("matrix_pencil: d0 M is recognised as Rayleigh damping", "[stability]") {
    Random random(904);
    for (int repeat = 0; repeat < 100; ++repeat) {
        auto system = wild_matrices(random);
        const double d0 = log_uniform(random, 1e-3, 1e3);
        const Eigen::MatrixXd D = (d0 * system.mass()).asDiagonal();
        const MatrixPencil pencil(
            LinearSystem<double>(system.mass(), sparse(D), system.stiffness()));
        // d0 itself comes out of a division, so it may miss by a rounding; a claim is exact.
        if (pencil.is_rayleigh()) {
            CHECK_THAT(pencil.rayleigh().mass_proportional, WithinRel(d0, 1e-15));
            CHECK(((pencil.rayleigh().mass_proportional * system.mass())
                       .isApprox(D.diagonal(), 1e-15)));
        }
        CHECK(pencil.damping_semidefinite());
        const MatrixPencil none(LinearSystem<double>(system.mass(), {}, system.stiffness()));
        CHECK(none.is_rayleigh());
        CHECK(none.rayleigh().mass_proportional == 0);
        // Negative damping is no Rayleigh damping.
        const MatrixPencil negative(
            LinearSystem<double>(system.mass(), sparse(-D), system.stiffness()));
        CHECK_FALSE(negative.is_rayleigh());
        CHECK_FALSE(negative.damping_semidefinite());
    }
    const Eigen::Vector3d mass(1, 2, 4);
    const Eigen::Matrix3d D = Eigen::Vector3d(0.5, 1, 2).asDiagonal();
    const Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    const MatrixPencil pencil(LinearSystem<double>(mass, sparse(D), sparse(K)));
    CHECK(pencil.is_rayleigh());
    CHECK(pencil.rayleigh().mass_proportional == 0.5);
}

TEST_CASE("matrix_pencil: scaled() and shares", "[stability]") {
    Random random(905);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const auto system = wild_matrices(random);
        const MatrixPencil pencil(system);
        const double stiffness = over_decades(random, 2);
        const double mass = over_decades(random, 2);
        const auto scaled = pencil.scaled(stiffness, mass);
        const Eigen::MatrixXd K(system.stiffness());
        const Eigen::MatrixXd D(system.damping());
        CHECK((scaled->mass() == mass * system.mass()));
        CHECK(distance(Eigen::MatrixXd(scaled->assemble(matrices::K_plus)), stiffness * K) <=
              Tolerance<double>::rounding * stiffness * largest(K));
        const double on_D = pencil.is_rayleigh() ? mass : 1;
        CHECK(distance(Eigen::MatrixXd(scaled->assemble(matrices::D)), on_D * D) <=
              Tolerance<double>::rounding * on_D * largest(D));
        CHECK((pencil.mass() == system.mass()));

        const Eigen::VectorXd u = random_vector(random, pencil.size());
        CHECK(pencil.spring_shares(u).empty());
        double sum = 0;
        for (const auto& share : pencil.particle_shares(u)) sum += share.share;
        CHECK_THAT(sum, WithinAbs(1.0, Tolerance<double>::rounding));
        CHECK(static_cast<Index>(pencil.particle_shares(u).size()) == pencil.size());
    }
}

}  // namespace taut_test::matrix_pencil_test
