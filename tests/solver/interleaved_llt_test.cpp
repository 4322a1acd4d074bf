// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/solver/block_ordering.hpp>
#include <taut/solver/interleaved_llt.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::interleaved_llt_test {

namespace {

/// A sparse symmetric matrix with dominant diagonal whose factor has groups of columns of all
/// widths.
template <class Scalar>
taut::SparseMatrix<Scalar> draw_matrix(Random& random, int n, int entries) {
    std::vector<Eigen::Triplet<Scalar>> triplets;
    for (int i = 0; i < n; ++i) triplets.emplace_back(i, i, Scalar(2 * entries + 1));
    for (int e = 0; e < n * entries; ++e) {
        const auto i = static_cast<int>(random.below(n));
        const auto j = static_cast<int>(random.below(n));
        const auto value = static_cast<Scalar>(random.uniform(-0.5, 0.5));
        triplets.emplace_back(i, j, value);
        triplets.emplace_back(j, i, value);
    }
    taut::SparseMatrix<Scalar> A(n, n);
    A.setFromTriplets(triplets.begin(), triplets.end());
    return A;
}

template <class Solver, int Columns, class Scalar>
void check_solve(const Solver& solver, const taut::SparseMatrix<Scalar>& A, Random& random) {
    using Block = typename Solver::template Block<Columns>;
    const Block B = random.points<Scalar, Columns>(A.rows(), -1, 1).transpose();
    Eigen::SimplicialLLT<taut::SparseMatrix<Scalar>> eigen(A);
    const Block X = solver.solve(B);
    for (int c = 0; c < Columns; ++c) {
        const taut::VectorX<Scalar> expected = eigen.solve(taut::VectorX<Scalar>(B.col(c)));
        CHECK(distance(X.col(c), expected) <= Tolerance<Scalar>::rounding * largest(expected));
    }
}

}  // namespace

TEMPLATE_TEST_CASE("interleaved_llt: each column is what Eigen's LLT solves", "[solver]", float,
                   double) {
    Random random(1);
    for (const int n : {1, 2, 5, 40, 120}) {
        for (const int entries : {0, 1, 4}) {
            INFO("n " << n << ", entries " << entries);
            const auto A = draw_matrix<TestType>(random, n, entries);
            taut::InterleavedLLT<TestType> solver;
            solver.analyzePattern(A);
            solver.factorize(A);
            REQUIRE(solver.info() == Eigen::Success);
            check_solve<decltype(solver), 1>(solver, A, random);
            check_solve<decltype(solver), 3>(solver, A, random);
        }
    }
}

TEST_CASE("interleaved_llt: other orderings give the same solution", "[solver]") {
    Random random(2);
    const auto A = draw_matrix<double>(random, 60, 2);
    taut::InterleavedLLT<double, Eigen::NaturalOrdering<int>> natural;
    natural.analyzePattern(A);
    natural.factorize(A);
    check_solve<decltype(natural), 2>(natural, A, random);
    taut::InterleavedLLT<double, taut::BlockOrdering<>> blocks;
    blocks.analyzePattern(A);
    blocks.factorize(A);
    check_solve<decltype(blocks), 4>(blocks, A, random);
}

TEST_CASE("interleaved_llt: an indefinite matrix is reported, and a definite one after it solved",
          "[solver]") {
    Random random(3);
    const auto A = draw_matrix<double>(random, 30, 2);
    auto indefinite = A;
    indefinite.coeffRef(7, 7) = -50;
    taut::InterleavedLLT<double> solver;
    solver.analyzePattern(A);
    solver.factorize(indefinite);
    CHECK(solver.info() != Eigen::Success);
    solver.factorize(A);
    REQUIRE(solver.info() == Eigen::Success);
    check_solve<decltype(solver), 3>(solver, A, random);
}

}  // namespace taut_test::interleaved_llt_test
