// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/scene/cloth.hpp>
#include <taut/suitesparse/cholmod_simplicial.hpp>
#include <taut/stability/stability.hpp>

#include "../tight/check_cholesky.hpp"

namespace taut_test::suitesparse_cholmod_cholesky_test {

TEST_CASE("cholmod_cholesky: factorises, and says when it cannot", "[stability]") {
    check_factorization<taut::CholmodCholesky>();
}

TEST_CASE("cholmod_cholesky: its proofs", "[stability]") { check_proofs<taut::CholmodCholesky>(); }

TEST_CASE("cholmod_cholesky: Stability narrows with it as with Eigen's", "[stability]") {
    const auto cloth = taut::hanging_cloth<double>({9, 12});
    const auto state = cloth.initial_state();
    const auto method = taut::Method::symplectic_euler;
    const taut::Stability<double, taut::CholmodCholesky> by_cholmod(cloth, state);
    const taut::Stability<double> by_eigen(cloth, state);
    const auto narrow = by_cholmod.max_step(method, 1e-6);
    CHECK(narrow.certified > 0);
    CHECK(narrow.refuted <= narrow.certified * (1 + 1e-6));
    const auto other = by_eigen.max_step(method, 1e-6);
    CHECK(narrow.certified < other.refuted);
    CHECK(other.certified < narrow.refuted);
}

}  // namespace taut_test::suitesparse_cholmod_cholesky_test
