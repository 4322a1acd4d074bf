// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cmath>
#include <taut/integrator/implicit_euler.hpp>

#include "../support/catch.hpp"
#include "../support/cloth_scene.hpp"
#include "../support/compiled_once.hpp"
#include "../support/decompositions.hpp"
#include "../support/random_system.hpp"
#include "../support/returning_steps.hpp"
#include "../support/scene_dense.hpp"
#include "../support/stepper_battery.hpp"
#include "../support/tolerance.hpp"
#include "stepper_scenes.hpp"

// What an implicit step solves, and by which solvers. What all steppers promise: steppers_test.cpp.

namespace taut_test::implicit_euler_test {

using taut::GeneralLinearSystem;
using taut::ImplicitEuler;
using taut::LinearSystem;
using taut::Status;

namespace {

using Sparse = taut::SparseMatrix<double>;
using LinearState = taut::State<double, 1>;

Eigen::MatrixXd draw_matrix(Random& random) { return random_points(random, 12, 12, -1, 1); }
Eigen::VectorXd draw_mass(Random& random) { return random_vector(random, 12, 0.5, 2); }
LinearState draw_state(Random& random, Index n) {
    return {random.points<double, 1>(n, -1, 1), random.points<double, 1>(n, -1, 1)};
}
Sparse sparse(const Eigen::MatrixXd& dense) { return dense.sparseView(); }

/// The state after one step of [T6], from dense matrices.
LinearState dense_step(const GeneralLinearSystem<double>& system, LinearState u, double h) {
    const Eigen::MatrixXd M = system.mass().asDiagonal();
    const Eigen::MatrixXd K(system.stiffness()), D(system.damping());
    const Eigen::VectorXd b = M * flat(u.v) + h * (system.load() - K * flat(u.x));
    u.v = dense_solve(M + h * D + h * h * K, b).transpose();
    u.x += h * u.v;
    return u;
}

const std::vector<Kind> exact_kinds = [] {
    std::vector<Kind> kinds;
    for (const Kind& kind : all_kinds()) {
        if (kind.laws != Laws::any || (kind.dim == 3 && !kind.single)) kinds.push_back(kind);
    }
    return kinds;
}();

}  // namespace

TEST_CASE("implicit_euler: a step satisfies its own update equation", "[integrator]") {
    for (const Kind& kind : exact_kinds) {
        for (const double h : {0.001, 0.0625, 2.0}) {
            INFO(kind << ", h " << h);
            Random random(1);
            RandomOptions options;
            options.rayleigh = options.dampers = true;
            Scene scene = random_scene(random, kind, options);
            scene.pin(5);
            auto state = random_state(random, scene);  // pinned particles move, too
            const auto before = state;
            const taut::Report report = exact_implicit_euler(scene)->step(state, scene.rounded(h));
            REQUIRE(report);
            CHECK(report.residual < kind.accumulated());

            // (M + hD + h²K⁺)(v⁺ − v) = h(f − hK⁺v) on the free, with v of the pinned ones on the
            // right.
            const auto dense = dense_matrices(scene, before);
            const auto free = free_dofs(scene);
            const Eigen::MatrixXd A = dense.M + h * dense.D + h * h * dense.K_plus;
            const Eigen::VectorXd b =
                h * (flat_force(scene, before) - h * dense.K_plus * flat(before.v));
            Eigen::VectorXd v = flat(before.v);
            v(free) += dense_solve(A(free, free), b(free));
            const double size = v.cwiseAbs().maxCoeff();
            CHECK(gap(flat(state.v), v) <= kind.accumulated() * size);
            CHECK(gap(state.x, before.x + h * state.v) <= kind.rounding() * size);
            CHECK(state.time == scene.rounded(h));
        }
    }
}

TEST_CASE("implicit_euler: on crumpled poses the step matrix is positive definite at every h",
          "[integrator]") {
    for (const Kind& kind : {Kind{false, 1, Laws::hookean}, Kind{false, 2, Laws::hookean},
                             Kind{false, 3, Laws::any}}) {
        for (std::uint32_t seed = 1; seed <= 20; ++seed) {
            Random random(seed);
            RandomOptions options;
            options.pinned = random.below(3);
            options.dampers = seed % 2 == 0;
            options.rayleigh = seed % 3 == 0;
            const Scene scene = random_scene(random, kind, options);
            auto crumpled = random_state(random, scene);
            crumpled.x *= 0.25;
            crumpled.x.col(3) = crumpled.x.col(4);  // two particles in one place
            const auto dense = dense_matrices(scene, crumpled);
            const auto free = free_dofs(scene);
            for (const double h : {1e-3, 0.1, 10.0, 1e3}) {
                INFO(kind << ", seed " << seed << ", h " << h);
                auto state = crumpled;
                const auto stepper = kind.laws == Laws::any
                                         ? exact_implicit_euler(scene)
                                         : scene.stepper(taut::Method::implicit_euler);
                CHECK(stepper->step(state, scene.rounded(h), 5));
                CHECK((state.x.allFinite() && state.v.allFinite()));
                const Eigen::MatrixXd A =
                    (dense.M + h * dense.D + h * h * dense.K_plus)(free, free);
                CHECK(least_eigenvalue(A) >  // masses are ≥ ½
                      0.5 - Tolerance<double>::rounding * A.cwiseAbs().maxCoeff());
            }
        }
    }
}

TEST_CASE("implicit_euler: a linear system's step is that of T6", "[integrator]") {
    Random random(2);
    const Eigen::MatrixXd A = draw_matrix(random), B = draw_matrix(random);
    const LinearSystem<double> system(
        draw_mass(random), sparse(A + A.transpose() + 12 * Eigen::MatrixXd::Identity(12, 12)),
        sparse(B * B.transpose()), random_vector(random, 12, -1, 1));
    ImplicitEuler stepper(system);
    auto u = draw_state(random, 12);
    for (const double h : {0.125, 0.125, 4.0, 0.125}) {  // changes of h between steps are taken up
        const auto expected = dense_step(system, u, h);
        const taut::Report report = stepper.step(u, h);
        REQUIRE(report);
        CHECK(report.residual < Tolerance<double>::accumulated);
        CHECK(gap(u.v, expected.v) <= Tolerance<double>::accumulated);
        CHECK(gap(u.x, expected.x) <= Tolerance<double>::accumulated * 10);
    }
}

TEST_CASE("implicit_euler: an unsymmetric system is stepped by SparseLU, as a dense solve does",
          "[integrator]") {
    Random random(3);
    const Eigen::MatrixXd B = draw_matrix(random), G = draw_matrix(random);
    Eigen::MatrixXd K = B * B.transpose();
    K(0, 5) += 2;
    const GeneralLinearSystem<double> system(draw_mass(random), sparse(G - G.transpose()),
                                             sparse(K), random_vector(random, 12, -1, 1));
    ImplicitEuler<GeneralLinearSystem<double>, Eigen::SparseLU<Sparse>> stepper(system);
    CHECK_FALSE(stepper.symmetric);
    auto u = draw_state(random, 12);
    for (int i = 0; i < 5; ++i) {
        const auto expected = dense_step(system, u, 0.125);
        REQUIRE(stepper.step(u, 0.125));
        CHECK(gap(u.v, expected.v) <= Tolerance<double>::accumulated);
        CHECK(gap(u.x, expected.x) <= Tolerance<double>::accumulated);
    }
}

TEST_CASE("implicit_euler: any of Eigen's symmetric solvers gives the same step", "[integrator]") {
    using System = taut::SpringSystem<double, 3>;
    Random random(4);
    const auto system = random_like<System>(random);
    const auto start = random_state(random, system);
    auto by_gradients = start, by_upper = start, by_lu = start;
    ImplicitEuler gradients(system);
    gradients.configure([](auto& solver) { solver.setTolerance(1e-14); });
    ImplicitEuler<System, Eigen::SimplicialLLT<Sparse, Eigen::Upper>> upper(system);
    ImplicitEuler<System, Eigen::SparseLU<Sparse>> lu(system);
    REQUIRE(gradients.step(by_gradients, 0.01, 20));
    REQUIRE(upper.step(by_upper, 0.01, 20));
    REQUIRE(lu.step(by_lu, 0.01, 20));
    CHECK(gap(by_upper.x, by_gradients.x) <= Tolerance<double>::accumulated);
    CHECK(gap(by_upper.x, by_lu.x) <= Tolerance<double>::accumulated);
}

TEST_CASE("implicit_euler: the energy of a linear system never rises, at any step",
          "[integrator]") {
    Random random(5);
    const Eigen::MatrixXd A = draw_matrix(random), B = draw_matrix(random);
    const Eigen::VectorXd mass = draw_mass(random);
    for (const bool damped : {false, true}) {
        for (const double h : {0.01, 1.0, 100.0}) {
            const LinearSystem<double> system(mass, damped ? sparse(A * A.transpose()) : Sparse(),
                                              sparse(B * B.transpose()));
            auto u = draw_state(random, 12);
            ImplicitEuler stepper(system);
            const double first = system.energy(u);
            double energy = first;
            for (int i = 0; i < 200; ++i) {
                REQUIRE(stepper.step(u, h));
                const double next = system.energy(u);
                REQUIRE(next <= energy + Tolerance<double>::rounding * first);
                energy = next;
            }
            CHECK(energy < first);
        }
    }
}

TEST_CASE("implicit_euler: an indefinite step matrix is reported, not solved", "[integrator]") {
    // M + h²K = 1 − 4h² is positive up to h = ½ [T21].
    Sparse K(3, 3);
    K.setIdentity();
    K.coeffRef(1, 1) = -4;
    const LinearSystem<double> system(Eigen::VectorXd::Ones(3), {}, K);
    Random random(6);
    auto u = draw_state(random, 3);
    const auto before = u;
    ImplicitEuler stepper(system);
    for (const double h : {1.0, 0.505, 0.505})  // asked twice, told twice
        CHECK(stepper.step(u, h).status == Status::not_positive_definite);
    CHECK(same_bits(u, before));
    CHECK(stepper.step(u, 0.495));
    CHECK_FALSE(same_bits(u, before));
}

TEST_CASE("implicit_euler: matrices are factorised once for each of the last two h",
          "[integrator]") {
    Random random(7);
    const auto springs = random_system<double, 3>(random);
    const auto linear = taut::linearize(springs, springs.initial_state());
    auto u = linear.initial_state();
    ImplicitEuler stepper(linear);
    for (const auto& [h, expected] : returning_steps) {
        REQUIRE(stepper.step(u, h, 2));
        CHECK(stepper.factorizations() == expected);
        auto again = u, by_fresh = u;
        ImplicitEuler fresh(linear);
        REQUIRE(stepper.step(again, h));
        REQUIRE(fresh.step(by_fresh, h));
        CHECK(same_bits(again, by_fresh));
    }
    auto state = springs.initial_state();
    ImplicitEuler moving(springs);
    REQUIRE(moving.step(state, 0.01, 3));
    CHECK(moving.factorizations() == 3);
}

TEST_CASE("implicit_euler: float steps follow double ones", "[integrator]") {
    for (const int dim : {1, 2, 3}) {
        AnyState end[2];
        for (const bool single : {false, true}) {
            Random random(9);
            const Scene scene = random_scene(random, {single, dim, Laws::hookean});
            end[single] = random_state(random, scene);
            REQUIRE(exact_implicit_euler(scene)->step(end[single], scene.rounded(0.01), 10));
        }
        const double tolerance = Tolerance<float>::accumulated;
        CHECK(gap(end[0].x, end[1].x) < tolerance);
        CHECK(gap(end[0].v, end[1].v) < tolerance * end[0].v.cwiseAbs().maxCoeff());
    }
}

TEST_CASE("implicit_euler: the default solver errs far less than the step does",
          "[integrator][slow]") {
    for (const bool single : {false, true}) {
        for (const double stretch : {1e2, 1e3, 1e5}) {
            for (const double step : {1.0 / 60, 1.0 / 240}) {
                INFO("float " << single << ", stretch " << stretch << ", h " << step);
                taut::ClothOptions options{10, 12};
                options.stretch = stretch;
                options.bend = stretch / 10;
                const Scene cloth = cloth_scene({single, 3, Laws::hookean}, options);
                const double h = cloth.rounded(step);
                auto state = cloth.initial_state();
                const auto by_default = cloth.stepper(taut::Method::implicit_euler);
                const auto exact_stepper = exact_implicit_euler(cloth);
                for (int k = 0; k < 6; ++k) {
                    auto exact = state, fine = state;
                    REQUIRE(exact_stepper->step(exact, h));
                    REQUIRE(exact_stepper->step(fine, h / 8, 8));
                    REQUIRE(by_default->step(state, h));
                    CHECK(gap(state.x, exact.x) <= 0.2 * gap(exact.x, fine.x));
                }
            }
        }
    }
}

}  // namespace taut_test::implicit_euler_test
