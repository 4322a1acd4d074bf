// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::admitted_growth_test {

using taut::Method;

// D ⪰ −δM and K ⪰ −εM by rounding, both along (1, −1): what grows there grows faster than either
// alone, s² − δs − ε = 0.
TEST_CASE("admitted growth counts D and K where both lack in one vector", "[stability]") {
    Random random(1312);
    int admitted = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
        taut::SparseMatrix<double> D(2, 2), K(2, 2);
        const double d = log_uniform(random, 0.1, 10);
        const double k = log_uniform(random, 0.1, 10);
        const double delta = d * log_uniform(random, 1e-12, 1e-7);
        const double epsilon = k * log_uniform(random, 1e-16, 1e-14);
        for (int i = 0; i < 2; ++i) {
            D.insert(i, i) = (d - delta) / 2;
            D.insert(i, 1 - i) = (d + delta) / 2;
            K.insert(i, i) = (k - epsilon) / 2;
            K.insert(i, 1 - i) = (k + epsilon) / 2;
        }
        const taut::LinearSystem<double> system(Eigen::VectorXd::Ones(2), D, K);
        const taut::Stability<double> stability(system);
        const auto across = [](const auto& A) {
            return static_cast<long double>(A.coeff(0, 0)) - A.coeff(0, 1);
        };
        const long double lacks_d = -across(D), lacks_k = -across(K);
        const long double rate = lacks_d / 2 + std::sqrt(lacks_d * lacks_d / 4 + lacks_k);
        for (const Method method :
             {Method::symplectic_euler, Method::explicit_euler, Method::implicit_euler}) {
            const auto limit = taut::max_step(stability, method, 1e-3);
            if (limit.growth_rate > 0 || !(limit.certified_up_to > 0)) continue;
            CAPTURE(taut::name(method), delta, epsilon, limit.admitted_growth);
            ++admitted;
            CHECK(limit.certified == 0);
            CHECK(limit.admitted_growth >= rate * (1 - 1e-12L));
        }
    }
    CHECK(admitted > 100);
}

// A light mass on a pinned spring and a far heavier free pair, whose D - hK can be shown to be
// semi-definite but for a rate. Where its spring is compressed by rounding, K lacks as well.
// Nothing is safe up to 0 s.
TEST_CASE("admitted growth belongs to a step that is claimed", "[stability]") {
    taut::SparseMatrix<double> D(2, 2), K(2, 2);
    for (int i = 0; i < 2; ++i) {
        D.insert(i, i) = -1;
        for (int j = 0; j < 2; ++j) K.insert(i, j) = (1 + i) * (1 + j);
    }
    const taut::LinearSystem<double> system(Eigen::VectorXd::Ones(2), D, K);
    for (const Method method :
         {Method::symplectic_euler, Method::explicit_euler, Method::implicit_euler}) {
        const auto limit = taut::Stability<double>(system).max_step(method);
        CHECK(limit.certified == 0);
        CHECK(limit.certified_up_to == 0);
        CHECK(limit.cause != taut::Cause::rounding);
    }
}

}  // namespace taut_test::admitted_growth_test
