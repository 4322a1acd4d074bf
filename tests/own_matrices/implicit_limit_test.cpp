// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::implicit_limit_test {

using taut::Method;

// Bare matrices with D ⪰ −δM by rounding and K ⪰ −κM, both attained at u = (1, −1):
// uᵀ(M + hD + h²K)u = (1 − hδ − h²κ)·uᵀMu, so the step matrix turns singular before 1/√κ and 1/δ.
TEMPLATE_TEST_CASE("implicit Euler: a D that is semi-definite but for rounding counts in the limit",
                   "[stability]", float, double) {
    Random random(1310);
    for (int repeat = 0; repeat < 500; ++repeat) {
        const double e = std::numeric_limits<TestType>::digits > 30 ? 0x1p-36 : 0x1p-22;
        const double kappa = random.below(4) == 0 ? 0 : log_uniform(random, 1e-3, 1e3);
        const double delta = log_uniform(random, 1e-2, 1e2);
        const double m = std::exp2(std::floor(random.uniform(-8, 8)));
        const double s = std::exp2(std::floor(std::log2(delta / e))) * m;
        taut::SparseMatrix<TestType> D(2, 2), K(2, 2);
        for (int i = 0; i < 2; ++i) {
            D.insert(i, i) = static_cast<TestType>(s);
            D.insert(i, 1 - i) = static_cast<TestType>(s * (1 + e));
            K.insert(i, i) = static_cast<TestType>(-kappa * m);
        }
        const taut::LinearSystem<TestType> system(
            taut::VectorX<TestType>::Constant(2, static_cast<TestType>(m)), D, K);
        const double exact_delta = s * e / m;
        const double exact_kappa = -static_cast<double>(K.coeff(0, 0)) / m;
        const double singular =
            2 / (exact_delta + std::sqrt(exact_delta * exact_delta + 4 * exact_kappa));
        const taut::Stability<TestType> stability(system);
        for (const double tightness : {0.0, 1e-3}) {
            const auto limit = taut::max_step(stability, Method::implicit_euler, tightness);
            const auto h = static_cast<double>(limit.certified_up_to);
            CAPTURE(m, exact_delta, exact_kappa, singular, tightness);
            REQUIRE(limit.certified == 0);
            REQUIRE(h > 0.2 * singular);
            REQUIRE(h <= singular);
            // Without a buckled K no multiplier exceeds what is admitted: 1/(1 − hδ).
            if (kappa == 0)
                REQUIRE(1 / (1 - h * exact_delta) <= std::exp(h * limit.admitted_growth));
        }
    }
}

// 1/(2δ) = 7e-46 s is less than the least float: nothing is left to certify.
TEST_CASE("implicit Euler: a D that leaves no float to step by is not certified", "[stability]") {
    taut::SparseMatrix<float> D(2, 2), K(2, 2);
    for (int i = 0; i < 2; ++i) {
        D.insert(i, i) = 1e20f;
        D.insert(i, 1 - i) = std::nextafter(1e20f, 2e20f);
        K.insert(i, i) = 1;
    }
    const taut::LinearSystem<float> system(Eigen::VectorXf::Constant(2, 1.25e-32f), D, K);
    const auto limit = taut::Stability<float>(system).max_step(Method::implicit_euler);
    CHECK(limit.certified == 0);
    CHECK(limit.certified_up_to == 0);
    CHECK(limit.cause == taut::Cause::rounding);
}

}  // namespace taut_test::implicit_limit_test
