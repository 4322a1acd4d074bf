// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/stability/detail/quick_mode.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "wild_system.hpp"

namespace taut_test::quick_mode_test {

namespace matrices = taut::matrices;

using taut::stability_detail::leading_pair;
using taut::stability_detail::quick_mode;

namespace {

/// A grid of n × n particles whose masses and stiffnesses lie `decades` apart, some pinned.
template <int Dim>
taut::SpringSystem<double, Dim> wild_grid(Random& random, Index n, double decades) {
    taut::SpringSystem<double, Dim> system;
    for (Index i = 0; i < n * n; ++i) {
        system.add_particle(random.vector<double, Dim>(-1, 1),
                            log_uniform(random, 1, std::pow(10, decades)));
    }
    for (Index i = 0; i < n * n; ++i) {
        const auto join = [&](Index j) {
            system.add_spring(i, j, log_uniform(random, 1, std::pow(10, decades)));
        };
        if (i % n + 1 < n) join(i + 1);
        if (i + n < n * n) join(i + n);
        if (i % 17 == 0) system.pin(i);
    }
    return system;
}

}  // namespace

TEMPLATE_TEST_CASE("quick_mode: close to the largest eigenvalue, from below", "[stability]",
                   (std::integral_constant<int, 1>), (std::integral_constant<int, 2>),
                   (std::integral_constant<int, 3>)) {
    constexpr int Dim = TestType::value;
    Random random(830);
    int found = 0;
    for (const double decades : {0.0, 1.0, 6.0, 18.0, 60.0}) {
        for (int repeat = 0; repeat < 3; ++repeat) {
            const auto system = wild_grid<Dim>(random, 24, decades);
            const auto pencil = taut::SpringPencil<Dim>::at_pose(system, system.initial_state().x);
            taut::LanczosOptions sharp;
            sharp.basis = 40;
            sharp.restarts = 30;
            sharp.tolerance = 1e-8;
            const taut::Combination c = matrices::K_plus;
            const double truth = taut::largest_ritz_pair(pencil, c, sharp).value;
            const auto pair = leading_pair(pencil, c);
            INFO("decades " << decades << ", repeat " << repeat);
            CHECK_THAT(pair.vector.dot(pencil.mass().cwiseProduct(pair.vector)),
                       WithinRel(1.0, 1e-12));
            CHECK(pair.value <= truth * (1 + 1e-7));
            CHECK(pair.value >= truth * 0.95);
            const Eigen::VectorXd u = quick_mode(pencil, c);
            if (u.size() == 0) continue;
            ++found;
            // A start at the mode ends the search at once, and no further away.
            const auto again = leading_pair(pencil, c, pair.vector);
            CHECK(again.value >= pair.value * (1 - 1e-5));
        }
    }
    CHECK(found >= 9);
}

TEST_CASE("quick_mode: dampers and signs of any combination of D and K", "[stability]") {
    Random random(831);
    auto cloth = taut::hanging_cloth<double>({14, 12});
    for (Index s = 0; s < 40; ++s) {
        const Index a = random.below(cloth.size());
        const Index b = (a + 1 + random.below(cloth.size() - 1)) % cloth.size();
        cloth.add_spring(a, b, log_uniform(random, 1, 1e4), log_uniform(random, 1e-3, 1e2));
    }
    cloth.set_rayleigh({2, 1e-4});
    const auto state = deformed(cloth, 0.97, 0.01, 5);
    const auto pencil = taut::SpringPencil<3>::at_pose(cloth, state.x);
    for (const taut::Combination& c :
         {matrices::K_plus, matrices::D, 1e-4 * matrices::D + 1e-8 * matrices::K_plus}) {
        taut::LanczosOptions sharp;
        sharp.basis = 40;
        sharp.tolerance = 1e-6;
        const double truth = taut::largest_ritz_pair(pencil, c, sharp).value;
        const double value = leading_pair(pencil, c).value;
        CHECK(value <= truth * (1 + 1e-9));
        CHECK(value >= 0.95 * truth);
    }
}

}  // namespace taut_test::quick_mode_test
