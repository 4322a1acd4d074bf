// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::explicit_limit_test {

using taut::Method;
using Real = long double;

// D − hK ⪰ 0 at the limit says nothing of smaller steps where K is indefinite: D = −δM and K = −κM
// along (1, −1) meet it from δ/κ on alone, and below that the damping feeds energy in.
TEMPLATE_TEST_CASE("explicit Euler: a negative D counts beside a buckled K at every smaller step",
                   "[stability][slow]", float, double) {
    Random random(1311);
    int claimed = 0, refused = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
        const double least = std::numeric_limits<TestType>::digits > 30 ? 1e-11 : 2e-7;
        const double m = log_uniform(random, 1e-2, 1e2);
        const double k = log_uniform(random, 1, 100);
        const double d = std::sqrt(k) * random.uniform(0.2, 1);
        const double delta = d * log_uniform(random, least, 1e-5);
        const double kappa = delta * k / d * log_uniform(random, 0.1, 100);
        // Each matrix has u along (1, 1) and w along (1, −1).
        const auto matrix = [&](double u, double w) {
            taut::SparseMatrix<TestType> A(2, 2);
            for (int i = 0; i < 2; ++i) {
                A.insert(i, i) = static_cast<TestType>(m * (u + w) / 2);
                A.insert(i, 1 - i) = static_cast<TestType>(m * (u - w) / 2);
            }
            return A;
        };
        const auto D = matrix(d, -delta), K = matrix(k, -kappa);
        const auto along = [](const taut::SparseMatrix<TestType>& A, int sign) {
            return static_cast<Real>(A.coeff(0, 0)) + sign * static_cast<Real>(A.coeff(0, 1));
        };
        const auto mass = static_cast<TestType>(m);
        const taut::LinearSystem<TestType> system(taut::VectorX<TestType>::Constant(2, mass), D, K);
        const taut::Stability<TestType> stability(system);
        const auto check = [&](double h, double admitted) {
            for (const double share : {1e-9, 0.01, 0.1, 0.5, 1.0}) {
                for (const int sign : {1, -1}) {
                    const Real rate = (along(D, sign) - share * h * along(K, sign)) / mass;
                    CAPTURE(h, admitted, share, sign, delta, kappa);
                    CHECK(rate >= -admitted * (1 + 1e-12));
                }
            }
        };
        for (const double tightness : {0.0, 1e-3}) {
            const auto limit = taut::max_step(stability, Method::explicit_euler, tightness);
            const bool strictly = limit.certified > 0;
            const auto h = static_cast<double>(strictly ? limit.certified : limit.certified_up_to);
            if (h > 0) check(h, strictly ? 0 : limit.admitted_growth);
            if (tightness > 0) ++(h > 0 ? claimed : refused);
        }
        const double tried = d / k * random.uniform(0.01, 0.99);
        if (taut::certify(stability, Method::explicit_euler, tried).proved) check(tried, 0);
    }
    CHECK(claimed > 30);
    CHECK(refused > 50);
}

}  // namespace taut_test::explicit_limit_test
