// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <taut/network/tangent_matrix.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/solver/block_ordering.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::block_ordering_test {

using Sparse = taut::SparseMatrix<double>;

TEST_CASE("block_ordering: the compressed graph of a spring matrix is that of its free particles",
          "[solver]") {
    const auto cloth = taut::hanging_cloth<double>({7, 5});
    const taut::TangentMatrix<double, 3> blocks(cloth);
    const taut::TangentMatrix<double, 1> particles(cloth);
    const taut::solver_detail::CompressedGraph graph(blocks.zero());
    REQUIRE(graph.vertices() == 33);
    const Sparse expected = particles.zero();
    CHECK(graph.matrix.nonZeros() == expected.nonZeros());
    for (Index j = 0; j < expected.cols(); ++j) {
        CHECK(graph.first[j] == 3 * j);
        CHECK(std::equal(expected.innerIndexPtr() + expected.outerIndexPtr()[j],
                         expected.innerIndexPtr() + expected.outerIndexPtr()[j + 1],
                         graph.matrix.innerIndexPtr() + graph.matrix.outerIndexPtr()[j]));
    }
}

TEST_CASE("block_ordering: a permutation that keeps blocks together, and fills in as AMD does",
          "[solver]") {
    const auto cloth = taut::hanging_cloth<double>({24, 24});
    const taut::TangentMatrix<double, 3> tangent(cloth);
    auto A = tangent.zero();
    tangent.assemble(cloth, cloth.initial_state().x,
                     taut::matrices::M + 1e-4 * taut::matrices::K_plus, A);
    taut::BlockOrdering<>::PermutationType permutation;
    taut::BlockOrdering<>()(A, permutation);
    REQUIRE(permutation.size() == A.cols());
    std::vector<bool> seen(static_cast<std::size_t>(A.cols()), false);
    for (Index k = 0; k < A.cols(); k += 3) {
        const int first = permutation.indices()[k];
        CHECK(first % 3 == 0);
        for (int c = 0; c < 3; ++c) {
            CHECK(permutation.indices()[k + c] == first + c);
            seen[first + c] = true;
        }
    }
    CHECK(std::find(seen.begin(), seen.end(), false) == seen.end());

    Eigen::SimplicialLLT<Sparse> scalar(A);
    Eigen::SimplicialLLT<Sparse, Eigen::Lower, taut::BlockOrdering<>> block(A);
    Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> natural(A);
    const auto fill = [](const auto& llt) { return llt.matrixL().nestedExpression().nonZeros(); };
    CHECK(static_cast<double>(fill(block)) < 1.1 * static_cast<double>(fill(scalar)));
    CHECK(fill(block) < fill(natural));
    Random random(1);
    const Eigen::VectorXd b = random.points<double, 1>(A.rows(), -1, 1).transpose();
    const Eigen::VectorXd expected = scalar.solve(b);
    CHECK(distance(Eigen::VectorXd(block.solve(b)), expected) <=
          Tolerance<double>::accumulated * largest(expected));
}

TEST_CASE("block_ordering: matrices without blocks and without columns are ordered, too",
          "[solver]") {
    Sparse A(4, 4);
    A.setIdentity();
    A.coeffRef(0, 3) = A.coeffRef(3, 0) = 0.5;
    A.makeCompressed();
    taut::BlockOrdering<>::PermutationType permutation;
    taut::BlockOrdering<>()(A, permutation);
    std::vector<int> order(permutation.indices().data(), permutation.indices().data() + 4);
    std::sort(order.begin(), order.end());
    CHECK(order == std::vector<int>{0, 1, 2, 3});
    taut::BlockOrdering<>()(Sparse(0, 0), permutation);
    CHECK(permutation.size() == 0);
}

}  // namespace taut_test::block_ordering_test
