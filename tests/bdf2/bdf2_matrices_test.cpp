// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// BDF2 on matrices of one's own.
#include <Eigen/SparseLU>
#include <taut/bdf2/bdf2.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/dense.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::bdf2_matrices_test {

namespace {

using LinearState = taut::State<double, 1>;

constexpr Index size = 6;

Eigen::MatrixXd draw_matrix(Random& random) { return random.points<double, size>(size, -1, 1); }

Eigen::MatrixXd semidefinite(Random& random, int rank) {
    const Eigen::MatrixXd A = draw_matrix(random).leftCols(rank);
    return A * A.transpose();
}

LinearState draw_state(Random& random) {
    return {random.points<double, 1>(size, -1, 1), random.points<double, 1>(size, -1, 1)};
}

/// (u, v) of a state as one vector.
Eigen::VectorXd joined(const LinearState& u) {
    Eigen::VectorXd w(2 * size);
    w << u.x.transpose(), u.v.transpose();
    return w;
}

}  // namespace
TEST_CASE("bdf2: the energy norm of two successive states never rises, at any step", "[bdf2]") {
    // G-stability (G. Dahlquist 1978): for ẇ = Cw with no energy gain, BDF2 cannot gain in this
    // norm of two successive w. Semi-definite K and D: zero modes and undamped ones are among them.
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        Random random(seed);
        const Eigen::VectorXd mass = random.vector<double, size>(0.5, 2);
        const Eigen::MatrixXd K = semidefinite(random, 4) * (seed % 2 == 0 ? 1.0 : 1e4);
        const Eigen::MatrixXd D = semidefinite(random, static_cast<int>(seed % 4));
        const taut::LinearSystem<double> system(mass, D.sparseView(), K.sparseView());
        for (const double h : {1e-3, 0.1, 1.0, 1e3}) {
            INFO("seed " << seed << ", h " << h);
            auto u = draw_state(random);
            taut::Bdf2<taut::LinearSystem<double>, taut::SparseCholesky<double>> stepper(system);
            const auto squared = [&](const Eigen::VectorXd& w) {
                const auto v = w.tail(size);
                return w.head(size).dot(K * w.head(size)) + v.dot(mass.cwiseProduct(v));
            };
            Eigen::VectorXd past = joined(u);
            REQUIRE(stepper.step(u, h));
            Eigen::VectorXd now = joined(u);
            double norm = squared(now) + squared(2 * now - past);
            const double start = norm;
            for (int i = 0; i < 100; ++i) {
                REQUIRE(stepper.step(u, h));
                past = now;
                now = joined(u);
                const double next = squared(now) + squared(2 * now - past);
                // A zero mode drifts far: its rounding meets the stiffest spring.
                const double scale = start + now.head(size).squaredNorm() * largest(K);
                REQUIRE(next <= norm + scale * Tolerance<double>::rounding);
                norm = next;
            }
        }
    }
}

TEST_CASE("bdf2: an unsymmetric system is stepped by SparseLU, as a dense solve does", "[bdf2]") {
    Random random(6);
    Eigen::MatrixXd K = semidefinite(random, size);
    K(0, 5) += 2;
    const Eigen::MatrixXd D = draw_matrix(random);
    const Eigen::VectorXd mass = random.vector<double, size>(0.5, 2);
    const Eigen::VectorXd load = random.vector<double, size>(-1, 1);
    const taut::GeneralLinearSystem<double> system(mass, D.sparseView(), K.sparseView(), load);
    taut::Bdf2<taut::GeneralLinearSystem<double>, Eigen::SparseLU<taut::SparseMatrix<double>>>
        stepper(system);
    auto u = draw_state(random);
    const auto before = u;
    const double h = 0.125;
    REQUIRE(stepper.step(u, h));
    const auto now = u;
    REQUIRE(stepper.step(u, h));
    const Eigen::MatrixXd M = mass.asDiagonal();
    const double t = 2 * h / 3;
    const Eigen::VectorXd x = (4 * flat(now.x) - flat(before.x)) / 3;
    const Eigen::VectorXd b = M * (4 * flat(now.v) - flat(before.v)) / 3 + t * (load - K * x);
    const Eigen::VectorXd v = dense_solve(M + t * D + t * t * K, b);
    CHECK(distance(flat(u.v), v) <= Tolerance<double>::accumulated);
    CHECK(distance(flat(u.x), x + t * v) <= Tolerance<double>::accumulated);
}

}  // namespace taut_test::bdf2_matrices_test
