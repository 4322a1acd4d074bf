// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/tight/eigen_cholesky.hpp>

#include "check_cholesky.hpp"

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
    check_factorization<taut::EigenCholesky>();
}

TEST_CASE("eigen_cholesky: its proofs", "[stability]") { check_proofs<taut::EigenCholesky>(); }

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
