// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/definitions.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/proof/bracket.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"

// The ends of long double: what double does not hold is not rounded to it unseen.

namespace taut_test::long_double_test {

using taut::Method;
using Long = long double;
using System = taut::SpringSystem<Long, 2>;
using Stability = taut::Stability<Long>;

namespace {

/// A pinned particle at the origin, and one of mass m at x.
System two_particles(const Eigen::Matrix<Long, 2, 1>& x, Long m) {
    System system;
    system.add_particle({0, 0}, 1);
    system.add_particle(x, m);
    system.pin(0);
    return system;
}

}  // namespace

TEST_CASE("long_double: poses are not rounded to double before they are analysed", "[extremes]") {
    if constexpr (std::numeric_limits<Long>::digits <= std::numeric_limits<double>::digits) return;
    Random random(1660);
    for (int repeat = 0; repeat < 40; ++repeat) {
        // Two springs at a right angle whose lengths are lost beside their distance from 0.
        const auto gap = static_cast<Long>(log_uniform(random, 0.03, 30)) * 0x1p-53L;
        const Eigen::Matrix<Long, 2, 1> corner(1, 1);
        System system;
        const auto m = static_cast<Long>(random.uniform(0.5, 2));
        system.add_particle(corner, m);
        system.add_particle(corner + Eigen::Matrix<Long, 2, 1>(gap, 0), 1);
        system.add_particle(corner + Eigen::Matrix<Long, 2, 1>(0, gap), 1);
        const auto k = static_cast<Long>(random.uniform(10, 100));
        system.add_spring(0, 1, k);
        system.add_spring(0, 2, k / 2);
        system.pin(1);
        system.pin(2);
        const Stability stability(system, system.initial_state());
        const auto free = taut::bracket(stability, Method::symplectic_euler);
        const Long truth = 2 / std::sqrt(k / m);
        CAPTURE(repeat);
        CHECK((free.certified <= truth && free.certified >= truth * (1 - 1e-9L)));
        CHECK((free.refuted >= truth && free.refuted <= truth * (1 + 1e-9L)));

        // A spring pressed from 1 m to that gap: −κ = T/(l·m).
        auto pressed = two_particles({1 + gap, 0}, m);
        pressed.add_spring(taut::Spring<Long, taut::Hookean>{0, 1, {k}, 1});
        auto state = pressed.initial_state();
        state.x(0, 0) = 1;
        const Long l = state.x(0, 1) - state.x(0, 0);
        const auto limit = taut::bracket(Stability(pressed, state), Method::symplectic_euler);
        CHECK_THAT(limit.growth_rate,
                   WithinRel(static_cast<double>(std::sqrt(k * (1 / l - 1) / m)), 1e-6));
        CHECK(limit.cause == taut::Cause::buckling);
    }
}

TEST_CASE("long_double: numbers that double does not hold are refused by name",
          "[extremes][bad_input]") {
    if constexpr (std::numeric_limits<Long>::max_exponent <= 2048) {
        return;
    } else {
        const auto refused = [](Long m, Long k, Long c) {
            auto system = two_particles({1, 0}, m);
            system.add_spring(0, 1, k, c);
            const auto any = taut::any_pose_limit(system);
            CHECK(any.certified == 0);
            CHECK(std::isinf(any.refuted));
            CHECK(any.cause == taut::Cause::overflow);
            return message_of([&] { (void)Stability(system, system.initial_state()).size(); });
        };
        CHECK(missing(refused(1, 1e-4000L, 0), {"stiffness of spring 0", "1e-4000"}) == "");
        CHECK(missing(refused(1, 1e4000L, 0), {"stiffness of spring 0", "1e+4000"}) == "");
        CHECK(missing(refused(1, 1, 1e-400L), {"damping of spring 0", "1e-400"}) == "");
        CHECK(missing(refused(1e-4000L, 1, 0), {"mass of particle 1", "1e-4000"}) == "");
        CHECK(missing(refused(1e4000L, 1, 0), {"mass of particle 1", "1e+4000"}) == "");
        const auto matrices = [](Long m, Long d, Long k) {
            taut::SparseMatrix<Long> D(2, 2);
            taut::SparseMatrix<Long> K(2, 2);
            D.insert(1, 1) = d;
            K.insert(1, 1) = k;
            const taut::LinearSystem<Long> system(taut::VectorX<Long>::Constant(2, m), D, K);
            return message_of([&] { (void)Stability(system).size(); });
        };
        CHECK(missing(matrices(1, 1, 1e-4000L), {"stiffness in row 1", "1e-4000"}) == "");
        CHECK(missing(matrices(1, 1e4000L, 1), {"damping in row 1", "1e+4000"}) == "");
        CHECK(missing(matrices(1e4000L, 1, 1), {"mass in row 0", "1e+4000"}) == "");
        CHECK(matrices(1, 0, 1) == "");
    }
}

TEST_CASE("long_double: matrices are semi-definite as they are, not as they round", "[extremes]") {
    if constexpr (std::numeric_limits<Long>::digits <= std::numeric_limits<double>::digits) return;
    const auto analysed = [](Long diagonal) {
        taut::SparseMatrix<Long> K(2, 2);
        K.insert(0, 0) = diagonal;
        K.insert(0, 1) = -1;
        K.insert(1, 0) = -1;
        K.insert(1, 1) = 1;
        const taut::LinearSystem<Long> system(taut::VectorX<Long>::Ones(2), {}, K);
        return Stability(system).max_step(Method::symplectic_euler);
    };
    // In double all three are the same matrix, [1, −1; −1, 1].
    CHECK(analysed(1).certified > 0);
    CHECK(analysed(1 + 0x1p-62L).certified > 0);
    const auto indefinite = analysed(1 - 0x1p-62L);
    CHECK(indefinite.certified == 0);
    CHECK(indefinite.certified_up_to > 0);
    CHECK(indefinite.cause == taut::Cause::rounding);
    CHECK(indefinite.admitted_growth >= std::sqrt(0x1p-63));
}

}  // namespace taut_test::long_double_test
