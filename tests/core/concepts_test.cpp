// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cstdint>
#include <taut/core/concepts.hpp>
#include <taut/model/spring_system.hpp>

#include "../support/catch.hpp"

namespace taut_test::concepts_test {

namespace {

/// The least that the System concept asks for: one free particle on a line, falling.
struct Falling {
    using Scalar = double;
    using State = taut::State<double, 1>;
    taut::Index size() const { return 1; }
    void force(const State&, taut::Points<double, 1>& f) const { f.setConstant(1, 1, -10); }
    Eigen::VectorXd inverse_mass() const { return Eigen::VectorXd::Ones(1); }
    std::uint64_t revision() const { return 0; }
    std::uint64_t force_revision() const { return 0; }
};

}  // namespace

TEST_CASE("concepts: the library's systems and a minimal one of the user's are Systems", "[core]") {
    taut::require_system<Falling>();
    taut::require_system<taut::SpringSystem<float, 2>>();
    taut::require_system<taut::LinearSystem<double>>();
    taut::require_system<taut::GeneralLinearSystem<double>>();
    SUCCEED();
}

TEST_CASE("concepts: Eigen's sparse solvers are Solvers, and symmetric ones are known as such",
          "[core]") {
    using Matrix = taut::SparseMatrix<double>;
    taut::require_solver<Eigen::SimplicialLLT<Matrix>, double>();
    taut::require_solver<Eigen::SparseLU<Matrix>, double>();
    taut::require_solver<Eigen::SparseLU<taut::SparseMatrix<float>>, float>();
    CHECK(taut::is_symmetric_solver_v<Eigen::SimplicialLLT<Matrix>>);
    CHECK(taut::is_symmetric_solver_v<Eigen::SimplicialLDLT<Matrix, Eigen::Upper>>);
    CHECK_FALSE(taut::is_symmetric_solver_v<Eigen::SparseLU<Matrix>>);
}

}  // namespace taut_test::concepts_test
