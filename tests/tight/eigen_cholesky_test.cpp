// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>

#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::eigen_cholesky_test {

using Sparse = Eigen::SparseMatrix<double>;

namespace {

/// The most nonzeros in a row of the Cholesky factor by boolean elimination.
Index widest_row_by_elimination(const Eigen::MatrixXd& ordered) {
    const Index n = ordered.rows();
    Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> L = ordered.array() != 0;
    Index widest = 0;
    for (Index j = 0; j < n; ++j) {
        L(j, j) = true;
        for (Index i = j + 1; i < n; ++i) {
            for (Index k = j + 1; k <= i && L(i, j); ++k) L(i, k) = L(i, k) || L(k, j);
        }
    }
    for (Index i = 0; i < n; ++i) widest = std::max(widest, L.row(i).head(i + 1).count());
    return widest;
}

}  // namespace

TEST_CASE("eigen_cholesky: factorises, and says when it cannot", "[tight]") {
    Random random(209);
    for (int repeat = 0; repeat < 50; ++repeat) {
        INFO("matrix " << repeat << " of seed 209");
        const Index n = 2 + random.below(12);
        const Sparse S = random_graph(random, n, 3).sparseView();
        taut::EigenCholesky cholesky;
        cholesky.analyze(S);
        REQUIRE(cholesky.factorize(S));
        // det S = Π l², whatever the order; the least pivot is no larger than their mean.
        CHECK(cholesky.least_pivot() > 0);
        CHECK(cholesky.least_pivot() <=
              std::pow(determinant(S), 1.0 / static_cast<double>(n)) * (1 + 1e-12));
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
    CHECK(cholesky.analyze(
              Eigen::MatrixXd(11 * Eigen::MatrixXd::Identity(9, 9) - Eigen::MatrixXd::Ones(9, 9))
                  .sparseView()) == 9);
}

TEST_CASE("factor_rows: the widest row of the factor, in any order of elimination", "[tight]") {
    Random random(208);
    for (int repeat = 0; repeat < 150; ++repeat) {
        INFO("matrix " << repeat << " of seed 208");
        const Index n = 2 + random.below(40);
        Eigen::MatrixXd A = random_graph(random, n, 1 + random.below(6));
        if (repeat % 4 == 0) {
            A.col(0).tail(n - 1).setConstant(0.01);
            A.row(0).tail(n - 1).setConstant(0.01);
        }
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
