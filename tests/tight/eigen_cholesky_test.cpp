// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <limits>
#include <taut/tight/certificate.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "definite_matrices.hpp"

namespace taut_test::eigen_cholesky_test {

namespace {

/// The most nonzeros in a row of the Cholesky factor by boolean elimination.
Index widest_row_by_elimination(const Sparse& ordered) {
    const Index n = ordered.rows();
    Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> L(n, n);
    L.setConstant(false);
    for (Index j = 0; j < n; ++j) {
        L(j, j) = true;
        for (Sparse::InnerIterator entry(ordered, j); entry; ++entry) L(entry.row(), j) = true;
    }
    Index widest = 0;
    for (Index j = 0; j < n; ++j) {
        for (Index i = j + 1; i < n; ++i) {
            for (Index k = j + 1; k <= i && L(i, j); ++k) L(i, k) = L(i, k) || L(k, j);
        }
    }
    for (Index i = 0; i < n; ++i) {
        Index count = 0;
        for (Index j = 0; j <= i; ++j) count += L(i, j) ? 1 : 0;
        widest = std::max(widest, count);
    }
    return widest;
}

}  // namespace

TEST_CASE("eigen_cholesky: factorises, and says when it cannot", "[stability]") {
    Random random(209);
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Index n = 2 + random.below(12);
        const Sparse S = random_graph(random, n, 3).sparseView();
        taut::EigenCholesky cholesky;
        cholesky.analyze(S);
        REQUIRE(cholesky.factorize(S));
        // det S = Π l², whatever the order; the least pivot is no larger than their mean.
        const double product = determinant(S);
        CHECK(cholesky.least_pivot() > 0);
        CHECK(cholesky.least_pivot() <=
              std::pow(product, 1.0 / static_cast<double>(n)) * (1 + 1e-12));
        Sparse bad = S;
        for (const double value : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
            bad.coeffRef(n - 1, n - 1) = value;
            CHECK_FALSE(cholesky.factorize(bad));
        }
        CHECK(cholesky.factorize(S));
    }
    // On a diagonal the pivots are its entries; on a full matrix the widest row is the last.
    taut::EigenCholesky cholesky;
    const Eigen::VectorXd diagonal = Eigen::VectorXd::LinSpaced(9, 0.5, 4.5);
    const Sparse D(Eigen::MatrixXd(diagonal.asDiagonal()).sparseView());
    CHECK(cholesky.analyze(D) == 1);
    REQUIRE(cholesky.factorize(D));
    CHECK_THAT(cholesky.least_pivot(), WithinRel(0.5, Tolerance<double>::rounding));
    CHECK(cholesky.analyze(constant_off_diagonal(9, 10, -1)) == 9);
}

// Matrices a hair below definite are refused, those as far above are not.
TEST_CASE("eigen_cholesky: its proofs", "[stability]") {
    Random random(210);
    const auto exact = [](const Eigen::VectorXd&) { return 0.0; };
    const auto proved = [&](const Sparse& A) { return taut::Prover{}(Sparse(A), exact).proved; };
    int refused = 0;
    for (int repeat = 0; repeat < 300; ++repeat) {
        const Index p = 1 + random.below(12);
        const Index q = 1 + random.below(12);
        const double least = static_cast<double>(grid_least(p, q, 0));
        for (const double hair : hairs) {
            const double diagonal = -least * (1 - hair);
            if (!(grid_least(p, q, diagonal) < 0)) continue;
            ++refused;
            CHECK_FALSE(proved(grid(p, q, diagonal)));
        }
        if (p * q > 1) CHECK(proved(grid(p, q, -least * (1 + 1e-9))));
        Eigen::MatrixXd A = random_graph(random, 2 + random.below(30), 4);
        CHECK(proved(A.sparseView()));
        if (make_indefinite(A, hairs[random.below(9)])) {
            ++refused;
            CHECK_FALSE(proved(A.sparseView()));
        }
    }
    CHECK(refused > 2000);
}

TEST_CASE("factor_rows: the widest row of the factor, in any order of elimination", "[stability]") {
    Random random(208);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const Index n = 2 + random.below(40);
        Eigen::MatrixXd A = random_graph(random, n, 1 + random.below(6));
        if (repeat % 4 == 0)
            A.col(0).tail(n - 1) = A.row(0).tail(n - 1).transpose().setConstant(0.01);
        const Sparse S = A.sparseView();
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order(n);
        order.setIdentity();
        for (Index i = n - 1; i > 0 && repeat % 2 == 0; --i) {
            order.applyTranspositionOnTheRight(i, random.below(i + 1));
        }
        Sparse ordered;
        ordered = S.twistedBy(order);
        const auto size =
            taut::solver_detail::factor_size(S, [&](Index i) { return Index(order.indices()[i]); });
        CHECK(size.widest_row == widest_row_by_elimination(ordered));
        const Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> plain(
            ordered);
        CHECK(size.entries == plain.matrixL().nestedExpression().nonZeros());
        // And the order that Eigen's factorisation chooses.
        const Eigen::SimplicialLLT<Sparse> llt(S);
        taut::EigenCholesky cholesky;
        Sparse chosen = S;
        if (llt.permutationP().size() > 0) chosen = S.twistedBy(llt.permutationP());
        CHECK(cholesky.analyze(S) == widest_row_by_elimination(chosen));
    }
}

}  // namespace taut_test::eigen_cholesky_test
