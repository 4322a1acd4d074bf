// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/proof/bracket.hpp>

#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::lanczos_test {

namespace matrices = taut::matrices;

using taut::Combination;
using taut::LanczosOptions;
using taut::largest_ritz_pair;
using MatrixPencil = taut::MatrixPencil<double>;

namespace {

constexpr double rounding = 100 * Tolerance<double>::rounding;

/// M⁻¹K with the given eigenvalues, M random.
taut::Pencil with_modes(Random& random, const Eigen::VectorXd& k) {
    Eigen::VectorXd mass(k.size());
    for (Index i = 0; i < k.size(); ++i) mass[i] = log_uniform(random, 0.1, 10);
    const Eigen::VectorXd root = mass.cwiseSqrt();
    const Eigen::MatrixXd K = root.asDiagonal() * with_spectrum(random, k) * root.asDiagonal();
    const Eigen::MatrixXd symmetric = 0.5 * (K + K.transpose());
    return MatrixPencil::of(taut::LinearSystem<double>(mass, {}, sparse(symmetric)));
}

taut::Pencil diagonal(const Eigen::VectorXd& k) {
    const Eigen::MatrixXd K = k.asDiagonal();
    return MatrixPencil::of(
        taut::LinearSystem<double>(Eigen::VectorXd::Ones(k.size()), {}, sparse(K)));
}

void check_consistent(const taut::Pencil& pencil, const Combination& c,
                      const taut::RitzPair& pair) {
    const Eigen::VectorXd& u = pair.vector;
    REQUIRE(u.size() == pencil.size());
    CHECK_THAT(u.dot(pencil.mass().cwiseProduct(u)), WithinRel(1.0, rounding));
    Eigen::VectorXd y;
    pencil.multiply(c, u, y);
    const Eigen::VectorXd root = pencil.mass().cwiseSqrt();
    const double size = std::max(std::abs(pencil.upper_bound(c)), std::abs(pair.value)) +
                        y.cwiseQuotient(root).norm();
    CHECK_THAT(u.dot(y), WithinAbs(pair.value, rounding * size));
    const Eigen::VectorXd r = (y - pair.value * pencil.mass().cwiseProduct(u)).cwiseQuotient(root);
    CHECK_THAT(pair.residual, WithinAbs(r.norm(), rounding * size));
    CHECK(pair.products > 0);
}

}  // namespace

TEST_CASE("lanczos: the small eigensolver's vectors are orthonormal and diagonalise, at any scale",
          "[proof]") {
    Random random(806);
    for (int repeat = 0; repeat < 300; ++repeat) {
        const Index m = 1 + random.below(40);
        const double scale = log_uniform(random, 1e-250, 1e250);
        Eigen::MatrixXd A(m, m);
        // Entries of every size, so that columns end in what is nothing beside their heads.
        for (Index j = 0; j < m; ++j) {
            for (Index i = j; i < m; ++i) {
                const double size = repeat % 2 == 0 ? 1 : log_uniform(random, 1e-200, 1);
                A(i, j) = A(j, i) = scale * (size * random.uniform(-1, 1));
            }
        }
        const auto spectrum = taut::proof_detail::small_spectrum({A.data(), A.data() + A.size()},
                                                                 static_cast<std::size_t>(m));
        const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(spectrum.values.data(), m);
        const Eigen::MatrixXd vectors =
            Eigen::Map<const Eigen::MatrixXd>(spectrum.vectors.data(), m, m);
        const double tolerance = rounding * static_cast<double>(m);
        const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(m, m);
        CHECK((vectors.transpose() * vectors - I).cwiseAbs().maxCoeff() < tolerance);
        const Eigen::MatrixXd left = A / scale * vectors - vectors * (values / scale).asDiagonal();
        CHECK(left.cwiseAbs().maxCoeff() < tolerance);
        for (Index i = 1; i < m; ++i) CHECK(values[i] >= values[i - 1]);
    }
    CHECK(taut::proof_detail::small_spectrum(std::vector<double>(9, 0), 3).values ==
          std::vector<double>(3, 0));
}

TEST_CASE("lanczos: of a tridiagonal matrix some rows of the eigenvectors alone are the same",
          "[proof]") {
    Random random(807);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const auto m = static_cast<std::size_t>(1 + random.below(24));
        std::vector<double> diagonal;
        std::vector<double> off_diagonal;
        for (std::size_t j = 0; j < m; ++j) diagonal.push_back(random.uniform(-1, 1));
        // Some of them nothing: the matrix falls apart.
        for (std::size_t j = 0; j + 1 < m; ++j)
            off_diagonal.push_back(random.below(4) == 0 ? 0 : random.uniform(-1, 1));
        const auto all = taut::proof_detail::tridiagonal_spectrum(
            diagonal, off_diagonal, taut::proof_detail::small_identity(m));
        std::vector<double> last_row(m, 0);
        last_row.back() = 1;
        const auto last =
            taut::proof_detail::tridiagonal_spectrum(diagonal, off_diagonal, last_row);
        CHECK(last.values == all.values);
        for (Index j = 0; j < static_cast<Index>(m); ++j) {
            const double* u = all.vector(j);
            CHECK(*last.vector(j) == u[m - 1]);
            for (std::size_t i = 0; i < m; ++i) {
                double product = (diagonal[i] - all.values[j]) * u[i];
                if (i > 0) product += off_diagonal[i - 1] * u[i - 1];
                if (i + 1 < m) product += off_diagonal[i] * u[i + 1];
                CHECK_THAT(product, WithinAbs(0, rounding * static_cast<double>(m)));
            }
        }
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(taut::proof_detail::tridiagonal_spectrum({1, nan, 1}, {1, 1}, {1, 0, 0}).values.size() ==
          3);
}

TEST_CASE("lanczos: never above the largest eigenvalue, and there when the basis is whole",
          "[proof]") {
    Random random(800);
    for (int repeat = 0; repeat < 300; ++repeat) {
        const Index n = 1 + random.below(24);
        Eigen::VectorXd k(n);
        for (Index i = 0; i < n; ++i)
            k[i] = (random.below(4) == 0 ? -1 : 1) * log_uniform(random, 1e-6, 1);
        if (repeat % 3 == 0) k.setConstant(k[0]);  // one eigenvalue, n times
        if (repeat % 3 == 1 && n > 3)
            k.head(n / 2).setConstant(k.maxCoeff());  // the largest, often
        const auto pencil = with_modes(random, k);
        LanczosOptions whole;
        whole.basis = 24;
        const auto pair = largest_ritz_pair(pencil, matrices::K_plus, whole);
        INFO("system " << repeat << ", " << n << " unknowns");
        CHECK_THAT(pair.value, WithinAbs(k.maxCoeff(), rounding * k.cwiseAbs().maxCoeff()));
        check_consistent(pencil, matrices::K_plus, pair);
        const auto smallest = largest_ritz_pair(pencil, -matrices::K_plus, whole);
        CHECK_THAT(-smallest.value, WithinAbs(k.minCoeff(), rounding * k.cwiseAbs().maxCoeff()));
    }
}

TEST_CASE("lanczos: from below, and it converges", "[proof]") {
    Random random(801);
    for (int repeat = 0; repeat < 8; ++repeat) {
        INFO("repeat " << repeat << " of seed 801");
        const Index n = 60 + random.below(60);
        Eigen::VectorXd k(n);
        for (Index i = 0; i < n; ++i) k[i] = random.uniform(0, 1);
        const auto pencil = with_modes(random, k);
        const double truth = k.maxCoeff();
        double earlier = 0;
        for (const int basis : {2, 5, 12, 24, 48}) {
            LanczosOptions options;
            options.basis = basis;
            options.restarts = 0;
            const auto pair = largest_ritz_pair(pencil, matrices::K_plus, options);
            check_consistent(pencil, matrices::K_plus, pair);
            CHECK(pair.value <= truth * (1 + rounding));
            CHECK(pair.value >= earlier * (1 - rounding));
            CHECK(pair.products == basis);
            earlier = pair.value;
        }
        LanczosOptions sharp;
        sharp.restarts = 300;
        sharp.tolerance = 1e-9;
        const auto pair = largest_ritz_pair(pencil, matrices::K_plus, sharp);
        CHECK_THAT(pair.value, WithinRel(truth, 1e-9));
        CHECK(pair.residual <= 1e-9 * pair.value);
        // An eigenvalue lies within the residual of the Ritz value, whatever the options.
        const auto rough = largest_ritz_pair(pencil, matrices::K_plus);
        CHECK((k.array() - rough.value).abs().minCoeff() <= rough.residual + rounding);
        // A good start is as good as many restarts.
        LanczosOptions one;
        one.restarts = 0;
        const auto warm = largest_ritz_pair(pencil, matrices::K_plus, one, pair.vector);
        CHECK(warm.value >= pair.value * (1 - rounding));
    }
}

TEST_CASE("lanczos: a restart that raised nothing is the last", "[proof]") {
    Random random(808);
    int settled = 0;
    for (int repeat = 0; repeat < 30; ++repeat) {
        INFO("repeat " << repeat << " of seed 808");
        Eigen::VectorXd k(20 + random.below(40));
        for (Index i = 0; i < k.size(); ++i) k[i] = random.uniform(0, 1);
        const auto pencil = with_modes(random, k);
        LanczosOptions options;
        options.tolerance = 0;
        options.basis = 8;
        taut::RitzPair before;
        for (options.restarts = 0; options.restarts < 60; ++options.restarts) {
            const auto pair = largest_ritz_pair(pencil, matrices::K_plus, options);
            if (options.restarts > 0 && !(pair.value > before.value)) {
                ++settled;
                options.restarts = 1000;
                CHECK(largest_ritz_pair(pencil, matrices::K_plus, options).products ==
                      pair.products);
                break;
            }
            before = pair;
        }
    }
    CHECK(settled > 20);
}

TEST_CASE("lanczos: an exact eigenvector of a lower mode does not trap it", "[proof]") {
    Random random(802);
    for (const Index n : {2, 3, 10, 24, 40, 80}) {
        Eigen::VectorXd k(n);
        for (Index i = 0; i < n; ++i) k[i] = 1 + static_cast<double>(i);
        const auto pencil = diagonal(k);
        for (const Index mode : {Index(0), n / 2, n - 1}) {
            INFO("mode " << mode << " of " << n);
            LanczosOptions options;
            options.restarts = 100;
            options.tolerance = 1e-10;
            const Eigen::VectorXd start = Eigen::VectorXd::Unit(n, mode);
            const auto pair = largest_ritz_pair(pencil, matrices::K_plus, options, start);
            CHECK_THAT(pair.value, WithinRel(k[n - 1], 1e-9));
            check_consistent(pencil, matrices::K_plus, pair);
        }
    }
    // Nor does a subspace: two chains that know nothing of each other.
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(40, 40);
    for (Index i = 0; i < 40; ++i) {
        const double k = i < 20 ? 1 : 3;
        K(i, i) = 2 * k;
        if (i + 1 < 40 && i != 19) K(i, i + 1) = K(i + 1, i) = -k;
    }
    const taut::Pencil pencil =
        MatrixPencil::of(taut::LinearSystem<double>(Eigen::VectorXd::Ones(40), {}, sparse(K)));
    Eigen::VectorXd start = Eigen::VectorXd::Zero(40);
    start.head(20).setOnes();
    LanczosOptions options;
    options.restarts = 100;
    options.tolerance = 1e-10;
    CHECK_THAT(largest_ritz_pair(pencil, matrices::K_plus, options, start).value,
               WithinRel(static_cast<double>(eigenvalues(K.cast<Real>())[39]), 1e-9));
}

TEST_CASE("lanczos: one unknown, zero matrices, repeated and isolated eigenvalues", "[proof]") {
    const auto one = diagonal(Eigen::VectorXd::Constant(1, 7));
    CHECK_THAT(largest_ritz_pair(one, matrices::K_plus).value, WithinRel(7.0, rounding));
    CHECK_THAT(largest_ritz_pair(one, 2 * matrices::M - matrices::K_plus).value,
               WithinRel(-5.0, rounding));
    for (const Index n : {1, 2, 24, 25, 100}) {
        const auto zero = diagonal(Eigen::VectorXd::Zero(n));
        const auto pair = largest_ritz_pair(zero, matrices::K_plus);
        CHECK(pair.value == 0);
        CHECK(pair.residual == 0);
        CHECK(pair.vector.allFinite());
        CHECK_THAT(pair.vector.norm(), WithinRel(1.0, rounding));
        // A multiple of the identity, whose first Krylov space has one dimension.
        const auto same =
            largest_ritz_pair(diagonal(Eigen::VectorXd::Constant(n, 3)), matrices::K_plus);
        CHECK_THAT(same.value, WithinRel(3.0, rounding));
        CHECK(same.vector.allFinite());
        // One stiff mode among many equal ones.
        Eigen::VectorXd k = Eigen::VectorXd::Ones(n);
        k[n / 2] = 1e12;
        CHECK_THAT(largest_ritz_pair(diagonal(k), matrices::K_plus).value,
                   WithinRel(1e12, rounding));
        // All negative.
        CHECK_THAT(largest_ritz_pair(diagonal(-k), matrices::K_plus).value,
                   WithinAbs(n == 1 ? -1e12 : -1.0, rounding * 1e12));
    }
}

TEST_CASE("lanczos: springs over many decades, never above the truth", "[proof]") {
    Random random(803);
    for (int repeat = 0; repeat < 300; ++repeat) {
        INFO("system " << repeat << " of seed 803");
        const auto scene = wild_scene(random, {false, 1 + repeat % 3, Laws::hookean});
        const auto state = scene.initial_state();
        const Analysis analysis(scene, state);
        const auto& pencil = analysis.pencil();
        const auto c = wild_combination(random);
        const RealVector all = exact_eigenvalues(exact_matrices(scene, state.x), c);
        LanczosOptions whole;
        whole.basis = 24;
        const auto pair = largest_ritz_pair(pencil, c, whole);
        const Real size = all.cwiseAbs().maxCoeff();
        CHECK(static_cast<Real>(pair.value) <= all[all.size() - 1] + rounding * size);
        CHECK(static_cast<Real>(pair.value) >= all[all.size() - 1] - rounding * size);
        CHECK(pair.value <= pencil.upper_bound(c) + static_cast<double>(rounding * size));
    }
}

}  // namespace taut_test::lanczos_test
