// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/network/tangent_matrix.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/solver/conjugate_gradient.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/tolerance.hpp"
#include "step_matrices.hpp"

namespace taut_test::two_level_test {

using taut::ConjugateGradient;
using taut::SparseMatrix;
using taut::TwoLevel;
using taut::VectorX;
using taut::solver_detail::Aggregates;
using taut::solver_detail::BlockMatrix;

namespace {

template <class Scalar, int Dim>
BlockMatrix<Scalar, Dim> blocks_of(const SparseMatrix<Scalar>& A) {
    BlockMatrix<Scalar, Dim> blocks;
    blocks.set_pattern(A);
    blocks.set_values(A);
    return blocks;
}

struct Applied {
    Aggregates groups;
    Eigen::VectorXd z;
};
template <class Scalar, int Dim>
Applied apply(const SparseMatrix<double>& A, const Eigen::VectorXd& r) {
    const auto blocks = blocks_of<Scalar, Dim>(A.cast<Scalar>());
    Applied applied;
    applied.groups.build(blocks, 25);
    TwoLevel<Scalar, Dim> preconditioner;
    preconditioner.analyze(blocks);
    REQUIRE(preconditioner.factorize(blocks));
    VectorX<Scalar> z(A.rows());
    preconditioner.apply(blocks, r.cast<Scalar>(), z);
    applied.z = z.template cast<double>();
    return applied;
}

void check_formula(Random& random, bool single, int dim) {
    CAPTURE(single, dim);
    SparseMatrix<double> A = random_step_matrix(random, dim, 70, 80, 0.3);
    if (single) A = A.cast<float>().cast<double>().eval();
    const Eigen::VectorXd r = random.points<double, 1>(A.rows(), -1, 1).transpose();
    const auto [groups, z] = single     ? apply<float, 3>(A, r)
                             : dim == 1 ? apply<double, 1>(A, r)
                             : dim == 2 ? apply<double, 2>(A, r)
                                        : apply<double, 3>(A, r);
    REQUIRE(groups.count > 1);
    // Columns that move one group along one axis.
    Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(A.rows(), dim * groups.count);
    for (Index i = 0; i < A.rows(); ++i)
        Z(i, dim * groups.of[static_cast<std::size_t>(i / dim)] + i % dim) = 1;
    const Eigen::MatrixXd dense(A);
    Eigen::VectorXd expected = Z * dense_solve(Z.transpose() * dense * Z, Z.transpose() * r);
    for (Index i = 0; i < A.rows(); i += dim)
        expected.segment(i, dim) += dense_solve(dense.block(i, i, dim, dim), r.segment(i, dim));
    const double epsilon = single ? Tolerance<float>::epsilon : Tolerance<double>::epsilon;
    CHECK(distance(z, expected) <= 1e3 * epsilon * largest(expected));
}

/// What conjugate gradients with the diagonal blocks alone need until ‖b - A x‖ ≤ tolerance·‖b‖.
template <int Dim>
Index jacobi_iterations(const SparseMatrix<double>& A, const VectorX<double>& b, double tolerance) {
    const auto blocks = blocks_of<double, Dim>(A);
    taut::solver_detail::BlockJacobi<double, Dim> jacobi;
    jacobi.analyze(blocks);
    REQUIRE(jacobi.factorize(blocks));
    VectorX<double> r = b, z = b, p = VectorX<double>::Zero(b.size());
    double rz = 1;
    Index iterations = 0;
    for (; r.norm() > tolerance * b.norm(); ++iterations) {
        REQUIRE(iterations < 4 * b.size());
        jacobi.apply(blocks, r, z);
        const double next = r.dot(z);
        p = z + next / rz * p;
        rz = next;
        const VectorX<double> q = A * p;
        r -= rz / p.dot(q) * q;
    }
    return iterations;
}

/// M + K of a ring of `count`, every other mass and stiffness drawn over decades.
SparseMatrix<double> ring(Random& random, Index count, double mass, double stiffness) {
    SparseMatrix<double> A(count, count);
    for (Index i = 0; i < count; ++i) {
        const Index j = (i + 1) % count;
        const double k = stiffness * log_uniform(random, 1, 1e4);
        A.coeffRef(i, i) += mass * log_uniform(random, 1, 1e4) + k;
        A.coeffRef(j, j) += k;
        A.coeffRef(i, j) -= k;
        A.coeffRef(j, i) -= k;
    }
    A.makeCompressed();
    return A;
}

}  // namespace

TEST_CASE("two_level: groups are connected, and small only where nothing adjoins", "[solver]") {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const Index springs = 20 + 20 * static_cast<Index>(seed);
        const auto A = blocks_of<double, 2>(random_step_matrix(random, 2, 200, springs, 0.1));
        const std::size_t size = 5 + random.below(30);
        Aggregates groups;
        groups.build(A, size);
        std::vector<std::size_t> members(groups.count), reached(groups.count);
        std::vector<bool> adjoins(groups.count), started(groups.count), seen(A.rows());
        std::vector<Index> queue;
        for (Index start = 0; start < A.rows(); ++start) {
            const int group = groups.of[start];
            REQUIRE((group >= 0 && group < groups.count));
            ++members[group];
            if (started[group]) continue;
            started[group] = seen[start] = true;
            queue.assign(1, start);
            while (!queue.empty()) {
                const Index i = queue.back();
                queue.pop_back();
                ++reached[group];
                for (int k = A.begin(i); k < A.end(i); ++k) {
                    const int j = A.column(k);
                    if (groups.of[j] != group) {
                        adjoins[group] = true;
                    } else if (!seen[j]) {
                        seen[j] = true;
                        queue.push_back(j);
                    }
                }
            }
        }
        CHECK(members == reached);
        for (int group = 0; group < groups.count; ++group) {
            CHECK(members[group] > 0);
            // The first of two that adjoin may be small: when it grew, there was no other to join.
            if (adjoins[group] && group > 0 && 3 * members[group] < size) {
                INFO("group " << group << " of " << members[group] << ", size " << size);
                bool older = false;
                for (Index i = 0; i < A.rows(); ++i) {
                    if (groups.of[i] != group) continue;
                    for (int k = A.begin(i); k < A.end(i); ++k) {
                        older = older || groups.of[A.column(k)] < group;
                    }
                }
                CHECK_FALSE(older);
            }
        }
    }
}

TEST_CASE("two_level: z is the sum of both corrections", "[solver]") {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        for (int dim = 1; dim <= 3; ++dim) check_formula(random, false, dim);
        check_formula(random, true, 3);
    }
}

TEST_CASE("two_level: iterations hardly grow with a stiff cloth, and block Jacobi's do",
          "[solver]") {
    Index last = 0;
    for (const Index n : {18, 28}) {
        const auto cloth = taut::hanging_cloth<double>({n, n});
        const taut::TangentMatrix<double, 3> tangent(cloth);
        auto A = tangent.zero();
        tangent.assemble(cloth, cloth.initial_state().x,
                         taut::matrices::M + 0.01 * taut::matrices::K_plus, A);
        Random random(1);
        const VectorX<double> b = random.points<double, 1>(A.rows(), -1, 1).transpose();
        ConjugateGradient<double, 3> solver;
        solver.setTolerance(1e-4);
        solver.analyzePattern(A);
        solver.factorize(A);
        solver.solve(b);
        CHECK(solver.info() == Eigen::Success);
        const Index two = solver.iterations();
        const Index one = jacobi_iterations<3>(A, b, 1e-4);
        INFO("n = " << n << ": " << two << " and " << one);
        CHECK(2 * two < one);
        CHECK((last == 0 || 2 * two < 3 * last));
        last = two;
    }
}

TEST_CASE("two_level: solutions are a direct solver's down to the tolerance, over decades",
          "[solver][extremes]") {
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const double mass = log_uniform(random, 1e-12, 1e12);
        const double stiffness = mass * log_uniform(random, 1e-12, 1e6);
        const auto A = ring(random, 30 + random.below(100), mass, stiffness);
        const VectorX<double> b = random.points<double, 1>(A.rows(), -1, 1).transpose();
        ConjugateGradient<double, 1> solver;
        solver.setTolerance(1e-12);

        solver.analyzePattern(A);
        solver.factorize(A);
        REQUIRE(solver.info() == Eigen::Success);
        const VectorX<double> x = solver.solve(b);
        CHECK(solver.info() == Eigen::Success);
        const VectorX<double> expected =
            solve(Eigen::MatrixXd(A).cast<Real>(), b.cast<Real>()).cast<double>();
        // What b - A x itself cannot tell from zero.
        const double rounding =
            Tolerance<double>::epsilon * (A.cwiseAbs() * expected.cwiseAbs()).norm();
        const double left = (b - A * x).norm();
        CHECK(left <= 1.01e-12 * b.norm() + 100 * rounding);
        CHECK((x - expected).norm() <= 1e-3 * expected.norm());
    }
}

TEST_CASE("two_level: stiffness far beyond masses does not pass for an indefinite matrix",
          "[solver][extremes]") {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const auto A = ring(random, 30 + random.below(100), 1, 1e9);
        const VectorX<double> b = random.points<double, 1>(A.rows(), -1, 1).transpose();
        ConjugateGradient<double, 1> solver;
        solver.analyzePattern(A);
        solver.factorize(A);
        CHECK(solver.info() == Eigen::Success);
        const VectorX<double> x = solver.solve(b);
        CHECK(solver.info() == Eigen::Success);
        CHECK(x.allFinite());
        TwoLevel<float, 1> rounded;
        const SparseMatrix<float> near = A.cast<float>();
        const auto blocks = blocks_of<float, 1>(near);
        rounded.analyze(blocks);
        CHECK(rounded.factorize(blocks));
    }
}

TEST_CASE("two_level: a matrix indefinite among groups alone is refused", "[solver]") {
    const Index n = 100;
    SparseMatrix<double> A(n, n);
    for (Index i = 0; i < n; ++i) {
        A.coeffRef(i, i) = 1;
        A.coeffRef(i, (i + 1) % n) = A.coeffRef((i + 1) % n, i) = -0.6;  // rows add up to −0.2
    }
    A.makeCompressed();
    ConjugateGradient<double, 1> solver;
    solver.analyzePattern(A);
    solver.factorize(A);
    CHECK(solver.info() == Eigen::NumericalIssue);
}

TEST_CASE("two_level: no success is reported of what is not a number", "[solver]") {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (std::uint32_t seed = 1; seed <= 10; ++seed) {
            INFO("seed " << seed << ", " << bad);
            Random random(seed);
            SparseMatrix<double> A = random_step_matrix(random, 3, 60, 100, 0.3);
            VectorX<double> b = random.points<double, 1>(A.rows(), -1, 1).transpose();
            ConjugateGradient<double, 3> solver;
            solver.analyzePattern(A);
            solver.factorize(A);
            REQUIRE(solver.info() == Eigen::Success);
            const double good = b[3];
            b[3] = bad;
            solver.solve(b);
            CHECK(solver.info() == Eigen::NumericalIssue);
            b[3] = good;
            A.coeffs()[random.below(A.nonZeros())] = bad;
            solver.factorize(A);
            solver.solve(b);
            CHECK(solver.info() == Eigen::NumericalIssue);
        }
    }
}

}  // namespace taut_test::two_level_test
