// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <set>
#include <taut/model/block_pattern.hpp>
#include <utility>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::block_pattern_test {

using taut::BlockPattern;

TEMPLATE_TEST_CASE("block_pattern: the blocks of the pairs and of the diagonal, each once",
                   "[model]", (std::integral_constant<int, 1>), (std::integral_constant<int, 2>),
                   (std::integral_constant<int, 3>)) {
    constexpr int Dim = TestType::value;
    using Block = Eigen::Matrix<double, Dim, Dim>;
    Random random(60);
    for (int repeat = 0; repeat < 40; ++repeat) {
        const Index n = 1 + random.below(12);
        std::vector<std::pair<Index, Index>> pairs;
        for (Index p = 0; n > 1 && p < random.below(30); ++p) {
            const Index a = random.below(n);
            pairs.emplace_back(a, (a + 1 + random.below(n - 1)) % n);
        }
        const BlockPattern pattern(n, [&](const auto& visit) {
            for (const auto& [a, b] : pairs) visit(a, b);
        });
        std::set<std::pair<Index, Index>> expected;
        for (Index i = 0; i < n; ++i) expected.emplace(i, i);
        for (const auto& [a, b] : pairs) {
            expected.emplace(a, b);
            expected.emplace(b, a);
        }
        REQUIRE(pattern.columns() == n);
        REQUIRE(pattern.blocks() == static_cast<Index>(expected.size()));
        auto A = pattern.zero<double, Dim>();
        CHECK(A.isCompressed());
        CHECK(A.nonZeros() == Dim * Dim * pattern.blocks());
        Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(Dim * n, Dim * n);
        for (int pass = 0; pass < 2; ++pass) {
            for (const auto& [row, column] : expected) {
                Block block;
                for (double& entry : block.reshaped()) entry = random.uniform(-1, 1);
                pattern.add(A, pattern.place(row, column), column, block);
                dense.block<Dim, Dim>(Dim * row, Dim * column) += block;
            }
        }
        CHECK(Eigen::MatrixXd(A) == dense);
    }
}

}  // namespace taut_test::block_pattern_test
