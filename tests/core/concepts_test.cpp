// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cstdint>
#include <taut/core/concepts.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/contact/obstacle.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/laws.hpp"

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

namespace {

/// A law in double alone, as a user may write one, with slopes between two lengths.
struct InDouble {
    static constexpr bool convex = false;
    template <class Scalar>
    using Parameters = taut::Hookean::Parameters<Scalar>;
    using P = Parameters<double>;
    static double tension(const P& p, double L, double l) { return p.stiffness * (l - L); }
    static double tension_slope(const P& p, double, double) { return p.stiffness; }
    static double energy(const P& p, double L, double l) {
        return p.stiffness * (l - L) * (l - L) / 2;
    }
    static double stiffness_bound(const P& p, double) { return p.stiffness; }
};

/// An engine's own ground, with its own name for what it answers.
struct Ground {
    struct Hit {
        float distance;
        Eigen::Vector3f normal;
    };
    Hit surface(const Eigen::Vector3f& x) const { return {x.z(), Eigen::Vector3f::UnitZ()}; }
};

}  // namespace

TEST_CASE("concepts: the library's laws and a user's own are Laws", "[core]") {
    taut::require_law<taut::Hookean, float>();
    taut::require_law<taut::TensionOnly, double>();
    taut::require_law<taut::Buckling, float>();
    taut::require_law<taut_test::Glue, double>();
    taut::require_law<InDouble, double>();
    SUCCEED();
}

TEST_CASE("concepts: the library's obstacles and a user's own are Obstacles", "[core]") {
    taut::require_obstacle<taut::HalfSpace<float, 2>, Eigen::Vector2f>();
    taut::require_obstacle<taut::Sphere<double, 3>, Eigen::Vector3d>();
    taut::require_obstacle<Ground, Eigen::Vector3f>();
    SUCCEED();
}

}  // namespace taut_test::concepts_test
