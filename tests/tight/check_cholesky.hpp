// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <limits>
#include <taut/tight/certificate.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "definite_matrices.hpp"

// What every factorisation behind proofs owes.

namespace taut_test {

template <class Cholesky>
void check_factorization() {
    Random random(209);
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Index n = 2 + random.below(12);
        const Sparse S = random_graph(random, n, 3).sparseView();
        Cholesky cholesky;
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
    Cholesky cholesky;
    const Eigen::VectorXd diagonal = Eigen::VectorXd::LinSpaced(9, 0.5, 4.5);
    const Sparse D(Eigen::MatrixXd(diagonal.asDiagonal()).sparseView());
    CHECK(cholesky.analyze(D) == 1);
    REQUIRE(cholesky.factorize(D));
    CHECK_THAT(cholesky.least_pivot(), WithinRel(0.5, Tolerance<double>::rounding));
    CHECK(cholesky.analyze(constant_off_diagonal(9, 10, -1)) == 9);
}

/// Matrices a hair below definite are refused, those as far above are not.
template <class Cholesky>
void check_proofs() {
    Random random(210);
    const auto exact = [](const Eigen::VectorXd&) { return 0.0; };
    const auto proved = [&](const Sparse& A) {
        return taut::Prover<Cholesky>{}(Sparse(A), exact).proved;
    };
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

}  // namespace taut_test
