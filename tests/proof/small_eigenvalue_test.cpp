// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/proof/detail/small_eigenvalue.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/random.hpp"

namespace taut_test::small_eigenvalue_test {

namespace {

template <int Dim>
using Matrix = Eigen::Matrix<double, Dim, Dim>;

template <int Dim>
taut::proof_detail::SymmetricBlock block(const Matrix<Dim>& A) {
    taut::proof_detail::SymmetricBlock lower;
    for (int j = 0; j < Dim; ++j) {
        for (int i = j; i < Dim; ++i) lower(i, j) = A(i, j);
    }
    return lower;
}
template <int Dim>
double eigenvalue_upper_bound(const Matrix<Dim>& A) {
    return taut::proof_detail::eigenvalue_upper_bound(block<Dim>(A), Dim);
}
template <int Dim>
bool proved_above(const Matrix<Dim>& A, double sigma) {
    return taut::proof_detail::proved_above(block<Dim>(A), sigma);
}

/// The largest eigenvalue, by long double Jacobi-quality QR of the matrix divided by its size.
template <int Dim>
Real largest_eigenvalue(const Matrix<Dim>& A) {
    const Real size = static_cast<Real>(A.cwiseAbs().maxCoeff());
    if (size == 0) return 0;
    const RealMatrix scaled = A.template cast<Real>() / size;
    return size * eigenvalues(scaled)[Dim - 1];
}

/// QΛQᵀ in long double, then rounded.
template <int Dim>
Matrix<Dim> rotated(Random& random, const Eigen::Matrix<Real, Dim, 1>& lambda) {
    RealMatrix G(Dim, Dim);
    for (int i = 0; i < Dim * Dim; ++i) G.data()[i] = random.uniform(-1, 1);
    const RealMatrix Q = orthogonal(G);
    Matrix<Dim> A = (Q * lambda.asDiagonal() * Q.transpose()).template cast<double>();
    A.template triangularView<Eigen::StrictlyUpper>() = A.transpose();
    return A;
}

template <int Dim>
void check_bound(const Matrix<Dim>& A) {
    const Real truth = largest_eigenvalue<Dim>(A);
    const double bound = eigenvalue_upper_bound<Dim>(A);
    INFO(Dim << " dimensions: " << bound << " above " << static_cast<double>(truth));
    CHECK(static_cast<Real>(bound) >= truth);
    CHECK(static_cast<Real>(bound) <= truth * (1 + 1.1e-6L));
}

}  // namespace

TEMPLATE_TEST_CASE("small_eigenvalue: a bound, and within 1e-6", "[proof]",
                   (std::integral_constant<int, 1>), (std::integral_constant<int, 2>),
                   (std::integral_constant<int, 3>)) {
    constexpr int Dim = TestType::value;
    Random random(700 + Dim);
    for (int repeat = 0; repeat < 5000; ++repeat) {
        INFO("repeat " << repeat << " of seed " << 700 + Dim);
        Eigen::Matrix<Real, Dim, 1> lambda;
        const double spread = log_uniform(random, 1e-18, 1);
        for (int i = 0; i < Dim; ++i) lambda[i] = static_cast<Real>(log_uniform(random, spread, 1));
        switch (repeat % 5) {  // multiple roots, nearly multiple ones, zeros
            case 1: lambda.setConstant(lambda[0]); break;
            case 2: lambda[Dim - 1] = lambda[0] * (1 + static_cast<Real>(spread)); break;
            case 3: lambda[0] = 0; break;
            default: break;
        }
        if (lambda.maxCoeff() == 0) continue;
        // Rounding to double may push a zero eigenvalue just below zero; it is of no account here.
        Matrix<Dim> A = rotated<Dim>(random, lambda);
        check_bound<Dim>(A);
        const double scale = log_uniform(random, 1e-100, 1e100);
        check_bound<Dim>(scale * A);
    }
}

TEMPLATE_TEST_CASE("small_eigenvalue: sums of few springs", "[proof]",
                   (std::integral_constant<int, 2>), (std::integral_constant<int, 3>)) {
    constexpr int Dim = TestType::value;
    Random random(710 + Dim);
    for (int repeat = 0; repeat < 2000; ++repeat) {
        INFO("repeat " << repeat << " of seed " << 710 + Dim);
        Matrix<Dim> A = Matrix<Dim>::Zero();
        for (Index s = 0; s < 1 + random.below(6); ++s) {
            auto d = random.vector<double, Dim>(-1, 1);
            if (random.below(3) == 0) d.tail(Dim - 1).setZero();  // along an axis
            if (d.norm() == 0) continue;
            d.normalize();
            const Matrix<Dim> along = d * d.transpose();
            A += log_uniform(random, 1e-9, 1e9) * along;
        }
        if (A.trace() > 0) check_bound<Dim>(A);
    }
}

TEST_CASE("small_eigenvalue: zero, diagonal and extreme matrices", "[proof]") {
    CHECK(eigenvalue_upper_bound<1>(Matrix<1>::Zero()) == 0);
    CHECK(eigenvalue_upper_bound<2>(Matrix<2>::Zero()) == 0);
    CHECK(eigenvalue_upper_bound<3>(Matrix<3>::Zero()) == 0);
    for (const double size : {1e-300, 1e-200, 1e-30, 1.0, 1e30, 1e200, 1e300}) {
        check_bound<2>(size * Matrix<2>::Identity());
        check_bound<3>(size * Matrix<3>::Identity());
        for (int where = 0; where < 3; ++where) {
            Matrix<3> A = Matrix<3>::Zero();
            A(where, where) = size;
            const auto bound = static_cast<Real>(eigenvalue_upper_bound<3>(A));
            CHECK(bound >= static_cast<Real>(size));
            CHECK(bound <= static_cast<Real>(size) * (1 + 1.1e-6L));
        }
        // All ones: n, once.
        const double bound = eigenvalue_upper_bound<3>(size * Matrix<3>::Ones());
        CHECK(bound >= 3 * size);
        // Where squares overflow or vanish the trace is left: a bound, though a loose one.
        CHECK(bound <= 3.0001 * size);
    }
    // What is no number is never a bound that looks like one.
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        Matrix<3> A = Matrix<3>::Identity();
        A(1, 0) = A(0, 1) = bad;
        const double bound = eigenvalue_upper_bound<3>(A);
        CHECK((!std::isfinite(bound) || bound >= 3));
    }
}

TEST_CASE("small_eigenvalue: proved_above is never true below the largest eigenvalue", "[proof]") {
    Random random(720);
    int tested = 0;
    for (int repeat = 0; repeat < 3000; ++repeat) {
        INFO("repeat " << repeat << " of seed 720");
        Eigen::Matrix<Real, 3, 1> lambda;
        for (int i = 0; i < 3; ++i) lambda[i] = static_cast<Real>(log_uniform(random, 1e-12, 1));
        if (repeat % 2 == 0) lambda[1] = lambda[2];
        const Matrix<3> A = rotated<3>(random, lambda);
        const Real truth = largest_eigenvalue<3>(A);
        for (const double hair : {1e-16, 1e-15, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3, 0.5}) {
            const auto sigma = static_cast<double>(truth * (1 - static_cast<Real>(hair)));
            if (!(static_cast<Real>(sigma) < truth)) continue;
            ++tested;
            CHECK_FALSE(proved_above<3>(A, sigma));
        }
        CHECK(proved_above<3>(A, static_cast<double>(truth) * (1 + 1e-12)));
        CHECK_FALSE(proved_above<3>(A, std::nan("")));
        CHECK_FALSE(proved_above<3>(A, 0));
        CHECK_FALSE(proved_above<3>(A, -1));
    }
    CHECK(tested > 20000);
}

TEST_CASE("small_eigenvalue: proved_above where squares vanish or overflow", "[proof]") {
    for (const double size : {1e-300, 1e-170, 1e-100, 1e-60, 1.0, 1e60, 1e100, 1e170, 1e300}) {
        const Matrix<3> A = Matrix<3>::Constant(size);  // largest eigenvalue 3·size
        CHECK_FALSE(proved_above<3>(A, 2.9 * size));
        CHECK_FALSE(proved_above<3>(A, 1.5 * size));
    }
    CHECK(proved_above<3>(Matrix<3>::Constant(1e60), 3.1e60));
}

}  // namespace taut_test::small_eigenvalue_test
