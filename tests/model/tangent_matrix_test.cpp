// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/model/tangent_matrix.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::tangent_matrix_test {

namespace matrices = taut::matrices;

using taut::TangentMatrix;

TEMPLATE_TEST_CASE("tangent_matrix: assemble is the combination of dense M, K or K+, and D",
                   "[model]", (taut::SpringSystem<float, 2>), (taut::SpringSystem<double, 1>),
                   (taut::SpringSystem<double, 3, taut::Hookean, Glue>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(1);
    RandomOptions options;
    options.dampers = true;
    options.rayleigh = true;
    auto system = random_like<TestType>(random, options);
    system.pin(6);  // pinned particles in between, too
    const TangentMatrix<Scalar, Dim> tangent(system);
    const auto free = free_dofs(system);
    REQUIRE(tangent.size() == static_cast<Index>(free.size()));
    auto A = tangent.zero();
    CHECK(A.isCompressed());
    CHECK(largest(Eigen::Matrix<Scalar, -1, -1>(A)) == 0);

    const auto state = random_state(random, system);
    const auto dense = dense_matrices(system, state);
    // One matrix for all of them: assemble must clear what was there.
    for (const taut::Combination& c : {matrices::M, matrices::K, matrices::K_plus, matrices::D,
                                       matrices::M + 0.5 * matrices::D + 0.25 * matrices::K_plus,
                                       3 * matrices::M + 2 * matrices::D - 0.5 * matrices::K}) {
        tangent.assemble(system, state.x, c, A);
        const Eigen::MatrixXd expected = c.mass() * dense.M + c.damping() * dense.D +
                                         c.stiffness() * dense.K + c.projected() * dense.K_plus;
        const Eigen::Matrix<Scalar, -1, -1> assembled(A);
        const double rounding = Tolerance<Scalar>::rounding * (largest(dense.K) + largest(dense.M));
        CHECK(distance(assembled, expected(free, free)) <= rounding);
        CHECK(distance(assembled, assembled.transpose()) <= rounding);
    }
}

TEST_CASE("tangent_matrix: the pattern has one block for each joined pair of free particles",
          "[model]") {
    taut::SpringSystem<double, 3> system;
    for (int i = 0; i < 5; ++i) system.add_particle({double(i), 0, 0}, 1);
    system.add_spring(0, 1, 10);
    system.add_spring(1, 0, 10);  // a duplicate
    system.add_spring(1, 2, 10);  // to a pinned one
    system.add_spring(3, 0, 10);
    system.pin(2);
    const TangentMatrix<double, 3> tangent(system);
    const auto& free = tangent.free();
    CHECK(std::vector<Index>(free.begin(), free.end()) == std::vector<Index>{0, 1, 3, 4});
    const auto A = tangent.zero();
    CHECK(A.rows() == 12);
    CHECK(A.nonZeros() == 9 * (4 + 2 * 2));
    for (Index j = 0; j < A.outerSize(); ++j) {  // row indices ascend, as factorisations expect
        for (int e = A.outerIndexPtr()[j] + 1; e < A.outerIndexPtr()[j + 1]; ++e) {
            CHECK(A.innerIndexPtr()[e - 1] < A.innerIndexPtr()[e]);
        }
    }
}

TEST_CASE("tangent_matrix: values are written in place, and the pattern is that of K and D",
          "[model]") {
    Random random(2);
    const auto system = random_system<double, 2>(random);
    const TangentMatrix<double, 2> tangent(system);
    auto A = tangent.zero();
    const double* values = A.valuePtr();
    const Index entries = A.nonZeros();
    for (int trial = 0; trial < 3; ++trial) {
        tangent.assemble(system, random_state(random, system).x,
                         matrices::M + matrices::D + matrices::K_plus, A);
        CHECK(A.valuePtr() == values);
        CHECK(A.nonZeros() == entries);
    }
    const auto linear = system.linearize(system.initial_state());
    CHECK(linear.stiffness().nonZeros() == entries);
    CHECK(linear.damping().nonZeros() == entries);
}

TEST_CASE("tangent_matrix: with nothing free it is 0 by 0", "[model]") {
    taut::SpringSystem<double, 3> system;
    CHECK(TangentMatrix<double, 3>(system).zero().rows() == 0);
    system.add_particle({0, 0, 0}, 1);
    system.add_particle({1, 0, 0}, 1);
    system.add_spring(0, 1, 10);
    system.pin(0);
    system.pin(1);
    const TangentMatrix<double, 3> tangent(system);
    auto A = tangent.zero();
    CHECK(A.rows() == 0);
    tangent.assemble(system, system.initial_state().x, matrices::M + matrices::D + matrices::K_plus,
                     A);
    CHECK(A.nonZeros() == 0);
}

}  // namespace taut_test::tangent_matrix_test
