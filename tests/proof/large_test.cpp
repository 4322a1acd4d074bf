// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/proof/bracket.hpp>

#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"

// Rounding where sums are long, and bounds of cloths.

namespace taut_test::large_test {

using taut::Method;

namespace {

constexpr Index many = 100'000;

/// A long row of springs with dampers, each particle a little off its place.
Scene long_row(Random& random, int dim) {
    Scene scene({false, dim, Laws::hookean});
    for (Index i = 0; i < many; ++i) {
        Eigen::VectorXd x = random_vector(random, dim, -0.2, 0.2);
        x[0] += static_cast<double>(i);
        scene.add_particle(x, random.uniform(0.5, 2));
        if (i == 0) continue;
        const double k = random.uniform(1, 3);
        const double rest = random.uniform(0.5, 1.5);
        scene.add_spring({i - 1, i, k, rest, random.uniform(0, 0.1)});
    }
    return scene;
}

struct ExactQuotients {
    Real k, d;
};

/// uᵀKu/uᵀMu and uᵀDu/uᵀMu in long double, spring by spring [T2].
ExactQuotients exact_quotients(const Scene& scene, const Eigen::VectorXd& u) {
    const auto x = scene.initial_state().x;
    const Index dim = scene.dim();
    Real m = 0, k = 0, d = 0;
    for (Index i = 0; i < u.size(); ++i)
        m += static_cast<Real>(scene.mass(i / dim)) * static_cast<Real>(u[i]) * u[i];
    for (const AnySpring& s : scene.springs()) {
        Real l2 = 0, along = 0, all = 0;
        for (Index axis = 0; axis < dim; ++axis) {
            const Real dx = static_cast<Real>(x(axis, s.b)) - x(axis, s.a);
            const Real du = static_cast<Real>(u[dim * s.b + axis]) - u[dim * s.a + axis];
            l2 += dx * dx;
            along += dx * du;
            all += du * du;
        }
        along *= along / l2;
        const Real across = 1 - static_cast<Real>(s.rest_length) / std::sqrt(l2);
        k += s.stiffness * (along + across * (all - along));
        d += s.damping * along;
    }
    return {k / m, d / m};
}

/// How much of the true step 2/√k the bound certifies; the truth from above by a sharp Ritz value.
double tightness(const Scene& cloth, const AnyState& state) {
    const Analysis analysis(cloth, state);
    taut::LanczosOptions options;
    options.basis = 40;
    options.restarts = 50;
    options.tolerance = 1e-4;
    const double k =
        taut::largest_ritz_pair(analysis.pencil(), taut::matrices::K_plus, options).value;
    return std::sqrt(k / analysis.stiffness_spectrum().k_max.upper);
}

}  // namespace

TEST_CASE("large: a vector refutes no step that exact arithmetic would not refute",
          "[proof][slow]") {
    for (const int dim : {1, 2, 3}) {
        Random random(1600 + dim);
        const auto row = long_row(random, dim);
        const Analysis analysis(row, row.initial_state());
        const auto& pencil = analysis.pencil();
        for (int repeat = 0; repeat < 4; ++repeat) {
            const Eigen::VectorXd u = random_vector(random, pencil.size());
            const auto [k, d] = exact_quotients(row, u);
            const auto enclosed = taut::proof_detail::quotients(pencil, u, taut::matrices::K);
            INFO(dim << " dimensions, vector " << repeat << " of seed " << 1600 + dim);
            CHECK(static_cast<Real>(enclosed.k.lower()) <= k);
            CHECK(static_cast<Real>(enclosed.k.upper()) >= k);
            CHECK(static_cast<Real>(enclosed.d.lower()) <= d);
            CHECK(static_cast<Real>(enclosed.d.upper()) >= d);
            const Real limit = 4 / (d + std::sqrt(d * d + 4 * k));
            const Real refuted = taut::proof_detail::refuted_by(pencil, u);
            CHECK(refuted >= limit);
            CHECK(refuted <= limit * (1 + 1e-6L));
        }
    }
}

TEST_CASE("large: refuted is above a limit known in closed form, at 100 000 particles",
          "[proof][slow]") {
    // Oscillators on one pin, all alike: any vector is a mode, so nothing but rounding is between
    // its quotient and the truth.
    Random random(1610);
    for (const bool damped : {false, true}) {
        const double m = random.uniform(0.5, 2);
        const double k = random.uniform(1, 3);
        const double d0 = damped ? random.uniform(3, 5) * std::sqrt(k / m) : 0;
        Scene scene({false, 1, Laws::hookean});
        scene.add_particle(Eigen::VectorXd::Zero(1), 1);
        scene.pin(0);
        for (Index i = 1; i <= many; ++i) {
            scene.add_particle(Eigen::VectorXd::Ones(1), m);
            scene.add_spring({0, i, k, 1});
        }
        scene.set_rayleigh(d0, 0);
        const Analysis analysis(scene, scene.initial_state());
        const Real square = static_cast<Real>(k) / m;
        const Real d = d0;
        INFO("m = " << m << ", k = " << k << ", d0 = " << d0);
        const auto spectrum = analysis.stiffness_spectrum();
        CHECK(static_cast<Real>(spectrum.k_max.lower) <= square);
        CHECK(static_cast<Real>(spectrum.k_max.upper) >= square);
        CHECK(static_cast<Real>(spectrum.k_min.upper) >= square);
        const auto check_around = [&](Method method, Real truth) {
            const auto limit = analysis.max_step(method);
            CHECK(static_cast<Real>(limit.certified) <= truth);
            CHECK(static_cast<Real>(limit.refuted) >= truth);
        };
        check_around(Method::symplectic_euler, 4 / (d + std::sqrt(d * d + 4 * square)));
        if (damped) check_around(Method::explicit_euler, 4 / (d + std::sqrt(d * d - 4 * square)));
    }
}

TEST_CASE("large: the bound keeps 0.92 of the true step of a cloth", "[proof]") {
    for (const Index size : {8, 12, 20, 32}) {
        const auto cloth = cloth_scene({size, size});
        const double noise = 0.1 / static_cast<double>(size);
        INFO(size << " x " << size);
        CHECK(tightness(cloth, cloth.initial_state()) >= 0.92);
        CHECK(tightness(cloth, deformed(cloth, 1.1, 0, 1)) >= 0.92);
        CHECK(tightness(cloth, deformed(cloth, 1.1, noise, 2)) >= 0.92);
        CHECK(tightness(cloth, deformed(cloth, 0.95, noise, 3)) >= 0.92);
    }
}

TEST_CASE("large: brackets of cloths narrowed, and certify beside them", "[proof][slow]") {
    const auto undamped = cloth_scene({16, 16});
    auto rayleigh = undamped;
    rayleigh.set_rayleigh(2, 1e-4);
    for (const auto& cloth : {undamped, rayleigh, with_dampers(undamped, 1e-3)}) {
        int pose = 0;
        for (const auto& state : {deformed(cloth, 1.1, 0.005, 1), deformed(cloth, 0.9, 0.01, 2)}) {
            INFO("pose " << pose++);
            const Analysis analysis(cloth, state);
            const auto limit = analysis.max_step(Method::symplectic_euler, 1e-6);
            CHECK(limit.certified > 0);
            CHECK(limit.refuted <= limit.certified * (1 + 1e-6) * (1 + 0x1p-50));
            const auto bound = analysis.max_step(Method::symplectic_euler);
            CHECK(limit.certified >= bound.certified);
            CHECK(limit.refuted <= bound.refuted);
            // certify finds the proof by itself, just below, and none above.
            CHECK(analysis.proves(Method::symplectic_euler, limit.certified * (1 - 1e-5)));
            CHECK_FALSE(analysis.proves(Method::symplectic_euler, limit.refuted));
        }
    }
}

}  // namespace taut_test::large_test
