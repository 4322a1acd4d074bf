// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/QR>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "wild_system.hpp"

namespace taut_test::limits_test {

using taut::Method;

namespace {

constexpr Index many = 100'000;

/// A long row of springs with dampers, each particle a little off its place.
template <int Dim>
taut::SpringSystem<double, Dim> long_row(Random& random) {
    using Vector = Eigen::Matrix<double, Dim, 1>;
    taut::SpringSystem<double, Dim> system;
    for (Index i = 0; i < many; ++i) {
        const Vector x =
            static_cast<double>(i) * Vector::Unit(0) + random.vector<double, Dim>(-0.2, 0.2);
        system.add_particle(x, random.uniform(0.5, 2));
        if (i == 0) continue;
        system.add_spring(taut::Spring<double, taut::Hookean>{
            i - 1, i, {random.uniform(1, 3)}, random.uniform(0.5, 1.5), random.uniform(0, 0.1)});
    }
    return system;
}

struct ExactQuotients {
    Real k;
    Real d;
};

/// uᵀKu/uᵀMu and uᵀDu/uᵀMu in long double, spring by spring [T2].
template <int Dim>
ExactQuotients exact_quotients(const taut::SpringSystem<double, Dim>& system,
                               const Eigen::VectorXd& u) {
    const auto state = system.initial_state();
    const auto& set = system.springs();
    Real m = 0, k = 0, d = 0;
    for (Index i = 0; i < u.size(); ++i)
        m += static_cast<Real>(system.mass(i / Dim)) * static_cast<Real>(u[i]) * u[i];
    for (std::size_t s = 0; s < set.a.size(); ++s) {
        Real l2 = 0, along = 0, all = 0;
        for (int axis = 0; axis < Dim; ++axis) {
            const Real dx = static_cast<Real>(state.x(axis, set.b[s])) - state.x(axis, set.a[s]);
            const Real du = static_cast<Real>(u[Dim * set.b[s] + axis]) - u[Dim * set.a[s] + axis];
            l2 += dx * dx;
            along += dx * du;
            all += du * du;
        }
        along *= along / l2;
        const Real stiffness = set.parameters[s].stiffness;
        const Real across = 1 - static_cast<Real>(set.rest_length[s]) / std::sqrt(l2);
        k += stiffness * (along + across * (all - along));
        d += static_cast<Real>(set.damping_of(s)) * along;
    }
    return {k / m, d / m};
}

}  // namespace

TEMPLATE_TEST_CASE("limits: a vector refutes no step that exact arithmetic would not refute",
                   "[stability][slow]", (std::integral_constant<int, 1>),
                   (std::integral_constant<int, 2>), (std::integral_constant<int, 3>)) {
    constexpr int Dim = TestType::value;
    Random random(1600 + Dim);
    const auto system = long_row<Dim>(random);
    const auto pencil = taut::SpringPencil<Dim>::at_pose(system, system.initial_state().x);
    for (int repeat = 0; repeat < 12; ++repeat) {
        const Eigen::VectorXd u = random_vector(random, pencil.size());
        const auto [k, d] = exact_quotients(system, u);
        const auto enclosed = taut::stability_detail::quotients(pencil, u, taut::matrices::K);
        CHECK(static_cast<Real>(enclosed.k.lower()) <= k);
        CHECK(static_cast<Real>(enclosed.k.upper()) >= k);
        CHECK(static_cast<Real>(enclosed.d.lower()) <= d);
        CHECK(static_cast<Real>(enclosed.d.upper()) >= d);
        const Real limit = 4 / (d + std::sqrt(d * d + 4 * k));
        const Real refuted = taut::stability_detail::refuted_by(pencil, u);
        INFO("vector " << repeat << ": " << static_cast<double>(refuted / limit - 1));
        CHECK(refuted >= limit);
        CHECK(refuted <= limit * (1 + 1e-6L));
    }
}

TEST_CASE("limits: refuted is above a limit known in closed form, at 100 000 particles",
          "[stability][slow]") {
    // Oscillators on one pin, all alike: any vector is a mode, so nothing but rounding is between
    // its quotient and the truth.
    Random random(1610);
    for (int repeat = 0; repeat < 6; ++repeat) {
        const double m = random.uniform(0.5, 2);
        const double k = random.uniform(1, 3);
        const double d0 = repeat < 3 ? 0 : random.uniform(3, 5) * std::sqrt(k / m);
        taut::SpringSystem<double, 1> system;
        using Vector = Eigen::Matrix<double, 1, 1>;
        system.add_particle(Vector(0.0), 1);
        system.pin(0);
        for (Index i = 1; i <= many; ++i) {
            system.add_particle(Vector(1.0), m);
            system.add_spring(0, i, k);
        }
        system.set_rayleigh({d0, 0});
        const taut::Stability<double> stability(system, system.initial_state());
        const Real square = static_cast<Real>(k) / m;
        const Real d = d0;
        INFO("m = " << m << ", k = " << k << ", d0 = " << d0);
        const auto spectrum = stability.stiffness_spectrum();
        CHECK(static_cast<Real>(spectrum.k_max.lower) <= square);
        CHECK(static_cast<Real>(spectrum.k_max.upper) >= square);
        CHECK(static_cast<Real>(spectrum.k_min.upper) >= square);
        const auto check_around = [](const taut::StepLimit<double>& limit, Real truth) {
            CHECK(static_cast<Real>(limit.certified) <= truth);
            CHECK(static_cast<Real>(limit.refuted) >= truth);
        };
        check_around(stability.max_step(Method::symplectic_euler),
                     4 / (d + std::sqrt(d * d + 4 * square)));
        if (d0 > 0) {
            check_around(stability.max_step(Method::explicit_euler),
                         4 / (d + std::sqrt(d * d - 4 * square)));
        }
    }
}

TEST_CASE("limits: explicit Euler under any diagonal damping, whatever the unit of time",
          "[stability]") {
    Random random(1620);
    for (int repeat = 0; repeat < 150; ++repeat) {
        const Index n = 2 + random.below(4);
        const double per_second = log_uniform(random, 1e-70, 1e70);
        // Dampers from those that K asks for [T12] to such as leave no vibration.
        const double strength = log_uniform(random, 1, 1e20);
        Eigen::VectorXd mass(n), d(n), k(n);
        Real truth = std::numeric_limits<Real>::infinity();
        for (Index i = 0; i < n; ++i) {
            mass[i] = log_uniform(random, 0.1, 10);
            const double k_i = random.below(4) == 0 ? 0 : log_uniform(random, 0.1, 1);
            const double d_i = strength * random.uniform(0.5, 2);
            k[i] = k_i * per_second * per_second * mass[i];
            d[i] = d_i * per_second * mass[i];
            const Real kk = static_cast<Real>(k[i]) / mass[i];
            const Real dd = static_cast<Real>(d[i]) / mass[i];
            truth = std::min(truth,
                             dd * dd < 4 * kk ? dd / kk : 4 / (dd + std::sqrt(dd * dd - 4 * kk)));
        }
        const Eigen::MatrixXd D = d.asDiagonal();
        const Eigen::MatrixXd K = k.asDiagonal();
        const taut::Stability<double> stability(
            taut::LinearSystem<double>(mass, sparse(D), sparse(K)));
        INFO("system " << repeat << ", " << per_second << "/s, strength " << strength);
        const auto limit = stability.max_step(Method::explicit_euler);
        CHECK(static_cast<Real>(limit.certified) <= truth);
        CHECK(static_cast<Real>(limit.certified) >= truth * (1 - 3e-4L));
        CHECK(static_cast<Real>(limit.refuted) >= truth);
    }
}

TEST_CASE("limits: dampers without stiffness, at any strength", "[stability]") {
    for (int exponent = -150; exponent <= 150; exponent += 5) {
        const double d = std::pow(10.0, exponent);
        const Eigen::MatrixXd D = Eigen::Vector2d(d, 2 * d).asDiagonal();
        const taut::Stability<double> stability(taut::LinearSystem<double>(
            Eigen::Vector2d(1, 1), sparse(D), Eigen::SparseMatrix<double>(2, 2)));
        INFO("D = diag(1, 2) * " << d);
        for (const double tightness : {0.0, 1e-6}) {
            const auto limit = taut::max_step(stability, Method::explicit_euler, tightness);
            CHECK(limit.certified <= 1 / d);
            CHECK(limit.certified >= (1 - 2e-4) / d);
            CHECK(limit.refuted >= (1 - 1e-15) / d);
        }
    }
}

TEST_CASE("limits: the softest mode of indefinite matrices is found below a free translation",
          "[stability]") {
    Random random(77);
    for (const Index n : {3, 8, 40, 300}) {
        // K1 = 0, as of springs that nothing holds, and one direction that pushes outwards.
        Eigen::MatrixXd Q(n, n);
        for (Index j = 0; j < n; ++j)
            for (Index i = 0; i < n; ++i) Q(i, j) = j == 0 ? 1 : random.uniform(-1, 1);
        Q = Eigen::HouseholderQR<Eigen::MatrixXd>(Q).householderQ() *
            Eigen::MatrixXd::Identity(n, n);
        Eigen::VectorXd lambda(n);
        for (Index i = 0; i < n; ++i) lambda[i] = random.uniform(0.5, 1);
        lambda[0] = 0;
        lambda[n - 1] = -random.uniform(0.1, 0.4);
        Eigen::MatrixXd K = Q * lambda.asDiagonal() * Q.transpose();
        K = ((K + K.transpose()) / 2).eval();
        const taut::Stability<double> stability(taut::LinearSystem<double>(
            Eigen::VectorXd::Ones(n), Eigen::SparseMatrix<double>(n, n), sparse(K)));
        const auto k_min = stability.stiffness_spectrum().k_min;
        INFO(n << " degrees of freedom, least eigenvalue " << lambda[n - 1]);
        CHECK(k_min.lower <= lambda[n - 1] + 1e-12);
        CHECK(k_min.upper >= lambda[n - 1] - 1e-12);
        CHECK(k_min.upper <= 0.99 * lambda[n - 1]);
    }
}

}  // namespace taut_test::limits_test
