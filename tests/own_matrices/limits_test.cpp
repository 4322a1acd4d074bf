// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/proof/stability.hpp>

#include "../support/catch.hpp"
#include "matrices.hpp"

namespace taut_test::own_matrices {

using taut::Method;

namespace {

constexpr Method methods[] = {Method::symplectic_euler, Method::explicit_euler,
                              Method::implicit_euler};

RealMatrix alike(Real diagonal, Real across) {
    return RealMatrix{{diagonal, across}, {across, diagonal}};
}
/// What A lacks to be semi-definite along (1, −1).
Real lack(const RealMatrix& A) { return A(0, 1) - A(0, 0); }

}  // namespace

// D ⪰ −δM and K ⪰ −εM by rounding, both along (1, −1): what grows there grows faster than either
// alone, s² − δs − ε = 0.
TEST_CASE("limits: admitted growth counts D and K where both lack in one vector",
          "[own_matrices]") {
    Random random(1312);
    int admitted = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
        const double d = log_uniform(random, 0.1, 10);
        const double k = log_uniform(random, 0.1, 10);
        const double delta = d * log_uniform(random, 1e-12, 1e-7);
        const double epsilon = k * log_uniform(random, 1e-16, 1e-14);
        const Matrices m(RealVector::Ones(2), alike((d - delta) / 2, (d + delta) / 2),
                         alike((k - epsilon) / 2, (k + epsilon) / 2));
        const Real rate = lack(m.D) / 2 + std::sqrt(lack(m.D) * lack(m.D) / 4 + lack(m.K));
        for (const Method method : methods) {
            const auto limit = limit_of(m, method, 1e-3);
            if (limit.growth_rate > 0 || !(limit.certified_up_to > 0)) continue;
            CAPTURE(repeat, taut::name(method), delta, epsilon, limit.admitted_growth);
            ++admitted;
            CHECK(limit.certified == 0);
            CHECK(limit.admitted_growth >= rate * (1 - 1e-12L));
        }
    }
    CHECK(admitted > 100);
}

// D = −M, and K has a zero mode. Nothing is safe up to 0 s.
TEST_CASE("limits: admitted growth belongs to a step that is claimed", "[own_matrices]") {
    const Matrices m(RealVector::Ones(2), alike(-1, 0), RealMatrix{{1, 2}, {2, 4}});
    for (const Method method : methods) {
        for (const double tightness : {0.0, 1e-3}) {
            const auto limit = limit_of(m, method, tightness);
            CAPTURE(taut::name(method), tightness);
            CHECK(limit.certified == 0);
            CHECK(limit.certified_up_to == 0);
            CHECK(limit.cause != taut::Cause::rounding);
        }
    }
}

// Bare matrices with D ⪰ −δM by rounding and K ⪰ −κM, both attained at u = (1, −1):
// uᵀ(M + hD + h²K)u = (1 − hδ − h²κ)·uᵀMu, so the step matrix turns singular before 1/√κ and 1/δ.
TEST_CASE("limits: a D that is semi-definite but for rounding counts in the limit",
          "[own_matrices]") {
    for (const Digits digits : {Digits::of_float, Digits::of_double}) {
        Random random(1310);
        const double e = digits == Digits::of_double ? 0x1p-36 : 0x1p-22;
        for (int repeat = 0; repeat < 500; ++repeat) {
            const double kappa = random.below(4) == 0 ? 0 : log_uniform(random, 1e-3, 1e3);
            const double delta = log_uniform(random, 1e-2, 1e2);
            const double mass = std::exp2(std::floor(random.uniform(-8, 8)));
            const double s = std::exp2(std::floor(std::log2(delta / e))) * mass;
            const Matrices m(RealVector::Constant(2, mass), alike(s, s * (1 + e)),
                             alike(-kappa * mass, 0), digits);
            const auto exact_delta = static_cast<double>(lack(m.D) / mass);
            const auto exact_kappa = static_cast<double>(lack(m.K) / mass);
            const double singular =
                2 / (exact_delta + std::sqrt(exact_delta * exact_delta + 4 * exact_kappa));
            for (const double tightness : {0.0, 1e-3}) {
                const auto limit = limit_of(m, Method::implicit_euler, tightness);
                const double h = limit.certified_up_to;
                CAPTURE(repeat, mass, exact_delta, exact_kappa, singular, tightness);
                REQUIRE(limit.certified == 0);
                REQUIRE(h > 0.2 * singular);
                REQUIRE(h <= singular);
                // Without a buckled K no multiplier exceeds what is admitted: 1/(1 − hδ).
                if (kappa == 0)
                    REQUIRE(1 / (1 - h * exact_delta) <= std::exp(h * limit.admitted_growth));
            }
        }
    }
}

// Where no step is certified, and no scale of a K that falls changes that, none is called safe.
TEST_CASE("limits: what no scale certifies has none", "[own_matrices]") {
    Random random(1314);
    for (int repeat = 0; repeat < 20; ++repeat) {
        taut::SparseMatrix<double> K(2, 2);
        K.insert(0, 0) = -log_uniform(random, 1e-3, 1e3);
        K.insert(1, 1) = -log_uniform(random, 1e-3, 1e3);
        const taut::LinearSystem<double> system(Eigen::Vector2d(1, 2), {}, K);
        const taut::Stability<double> stability(system);
        const double h = log_uniform(random, 1e-6, 1e3);
        CHECK(stability.max_step(Method::explicit_euler).certified == 0);
        CHECK(stability.max_stiffness_scale(Method::explicit_euler, h) == 0);
        CHECK(std::isinf(stability.min_mass_scale(Method::explicit_euler, h)));
    }
}

// 1/(2δ) = 7e-46 s is less than the least float: nothing is left to certify.
TEST_CASE("limits: a D that leaves no float to step by is not certified", "[own_matrices]") {
    const Matrices m(RealVector::Constant(2, 1.25e-32L), alike(1e20f, std::nextafter(1e20f, 2e20f)),
                     alike(1, 0), Digits::of_float);
    const auto limit = limit_of(m, Method::implicit_euler, 0);
    CHECK(limit.certified == 0);
    CHECK(limit.certified_up_to == 0);
    CHECK(limit.cause == taut::Cause::rounding);
}

}  // namespace taut_test::own_matrices
