// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/tight/dense.hpp>
#include <taut/tight/explicit_estimate.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../stability/wild_system.hpp"

namespace taut_test::explicit_estimate_test {

namespace matrices = taut::matrices;

using taut::explicit_estimate;
using Pencil3 = taut::SpringPencil<3>;

namespace {

double k_max(const taut::Pencil& pencil) { return pencil.upper_bound(matrices::K_plus); }

/// A cloth with dampers of many sizes: D commutes with nothing.
taut::SpringSystem<double, 3> damped_cloth(Random& random, Index rows, Index columns) {
    const auto plain = taut::hanging_cloth<double>({rows, columns});
    const auto state = plain.initial_state();
    taut::SpringSystem<double, 3> cloth;
    for (Index i = 0; i < plain.size(); ++i) {
        cloth.add_particle(state.x.col(i), plain.mass(i) * log_uniform(random, 0.5, 2));
    }
    const auto& springs = plain.springs();
    for (std::size_t s = 0; s < springs.a.size(); ++s) {
        const double k = springs.parameters[s].stiffness * log_uniform(random, 0.3, 3);
        cloth.add_spring(springs.a[s], springs.b[s], k, log_uniform(random, 0.05, 0.5));
    }
    cloth.pin(0);
    return cloth;
}

}  // namespace

TEST_CASE("explicit_estimate: exact where Rayleigh damping gives the limit in closed form",
          "[stability][slow]") {
    Random random(840);
    for (int repeat = 0; repeat < 6; ++repeat) {
        auto cloth = taut::hanging_cloth<double>({5 + random.below(4), 6});
        cloth.set_rayleigh(
            {repeat % 2 ? log_uniform(random, 1, 100) : 0, log_uniform(random, 1e-6, 1e-4)});
        const auto pencil = Pencil3::at_pose(cloth, cloth.initial_state().x);
        const double truth = taut::DenseAnalysis<>(pencil, taut::matrices::K).explicit_limit();
        CHECK_THAT(explicit_estimate(pencil, k_max(pencil)), WithinRel(truth, 0.05));
    }
}

TEST_CASE("explicit_estimate: near the dense answer under dampers", "[stability][slow]") {
    Random random(841);
    for (int repeat = 0; repeat < 6; ++repeat) {
        const auto cloth = damped_cloth(random, 7 + random.below(3), 8);
        const auto pencil = Pencil3::at_pose(cloth, cloth.initial_state().x);
        const double truth = taut::DenseAnalysis<>(pencil, taut::matrices::K).explicit_limit();
        const double estimate = explicit_estimate(pencil, k_max(pencil));
        INFO("repeat " << repeat << ", " << pencil.size() << " unknowns");
        CHECK(estimate > 0.95 * truth);
        CHECK(estimate < 1.3 * truth);
    }
}

TEST_CASE("explicit_estimate: no number where K is indefinite", "[stability]") {
    const auto cloth = taut::hanging_cloth<double>({6, 6});
    const auto squeezed = deformed(cloth, 0.5, 0, 1);
    const auto buckled = Pencil3::at_pose(cloth, squeezed.x);
    CHECK(std::isnan(explicit_estimate(buckled, k_max(buckled))));
}

TEST_CASE("explicit_estimate: Stability gives it beside the bracket, and only there",
          "[stability]") {
    Random random(842);
    const auto cloth = damped_cloth(random, 8, 8);
    const auto state = cloth.initial_state();
    const taut::Stability<double> stability(cloth, state);
    const auto method = taut::Method::explicit_euler;
    const auto by_bounds = stability.max_step(method);
    CHECK(by_bounds.estimate == 0);
    const auto narrowed = taut::max_step(stability, method, 0.1);
    CHECK(narrowed.estimate > 0);
    CHECK(narrowed.estimate >= narrowed.certified);
    CHECK(narrowed.estimate <= narrowed.refuted);
    CHECK(taut::max_step(stability, taut::Method::symplectic_euler, 0.1).estimate == 0);
    const auto few = damped_cloth(random, 3, 4);
    const taut::Stability<double> small(few, few.initial_state());
    CHECK(small.max_step(method).estimate == 0);
    const auto dense = taut::max_step(small, method, 0.1);
    CHECK(dense.estimate > 0);
    CHECK(dense.estimate <= dense.refuted * (1 + 1e-9));
    CHECK(dense.estimate >= dense.certified * (1 - 1e-9));
    auto rayleigh = taut::hanging_cloth<double>({8, 8});
    rayleigh.set_rayleigh({1, 1e-5});
    CHECK(taut::max_step(taut::Stability<double>(rayleigh, state), method, 1e-3).estimate == 0);
}

}  // namespace taut_test::explicit_estimate_test
