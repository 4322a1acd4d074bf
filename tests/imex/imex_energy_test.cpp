// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/catch.hpp"
#include "direct_imex.hpp"
#include "imex_scenes.hpp"

// [T41] with A in place of M: at what is certified no step raises ½vᵀAv + U by more than the work.

namespace taut_test::imex_energy_test {

namespace {

/// Networks stepped at h₀ and h₀/3 of their own choice of springs, up to a thousand times what the
/// explicit step bears.
void check_networks(const Kind& kind) {
    Random random(8810);
    int steps = 0, implicit = 0;
    for (int repeat = 0; repeat < 150; ++repeat) {
        INFO("network " << repeat);
        auto scene = random_network(random, kind, 3, repeat % 4 == 1);
        const double bears = scene.energy_limit().certified;
        if (!(bears < 1e30)) continue;
        const double step = bears * log_uniform(random, 0.5, 1000);
        if (repeat % 5 == 1) scene.set_rayleigh(random.uniform(0, 1) / step, 0);
        if (repeat % 5 == 2) scene.set_rayleigh(0, log_uniform(random, 1e-2, 1) * step);
        if (repeat % 5 == 3) scene.set_rayleigh(random.uniform(1, 1.9) / step, 0);
        const auto stepper = imex(scene, step);
        const double certified = stepper->limit().certified;
        REQUIRE(certified == scene.rounded(step));
        const ImexMatrices matrices(scene, step, [&](Index s) { return stepper->share(s); });
        CHECK(matrices.holds(static_cast<Real>(certified)));
        implicit += stepper->implicit_springs() > 0;
        auto state = thrown(random, scene);
        const double speed = state.v.cwiseAbs().maxCoeff();
        RealMatrix forces = RealMatrix::Zero(kind.dim, scene.size());
        for (int i = 0; i < 30; ++i) {
            for (Index p = 0; repeat % 3 == 1 && p < scene.size(); ++p) {
                if (scene.is_pinned(p))
                    state.v.col(p) = speed * random_vector(random, kind.dim, -1, 1);
            }
            for (Index p = 0; repeat % 4 == 2 && i % 5 == 0 && p < scene.size(); ++p) {
                const double impulse = random.uniform(0, 1) * speed * scene.mass(p) / certified;
                const Eigen::MatrixXd force =
                    rounded(scene, impulse * random_vector(random, kind.dim, -1, 1));
                scene.set_constant_force(p, force);
                if (!scene.is_pinned(p)) forces.col(p) = force.cast<Real>();
            }
            const double h = certified / (i % 2 == 0 ? 1 : 3);
            const Books books = book_imex(*stepper, scene, matrices, state, h, forces);
            ++steps;
            INFO("step " << i << ": " << books.gain << " J of " << books.kinetic << ", slack "
                         << books.slack);
            CHECK_FALSE(books.rises());
        }
    }
    CHECK(steps > 3000);
    CHECK(implicit > 80);
}

/// With A made for the edge of its rest, that edge is A's own: no step rises at it or below, and
/// above it some do.
void check_edge(Random& random, const Kind& kind, LawOf law, Beside beside) {
    const bool forced = beside == Beside::forces;
    bool above = false;
    for (int repeat = 0; repeat < 6; ++repeat) {
        const auto draw = [&] {
            AnySpring spring;
            spring.stiffness = random.uniform(50, 200);
            spring.law = law;
            return spring;
        };
        auto scene = line(random, kind, 3, draw, beside, 100, 300);
        const double even = random.uniform(0.2, 0.8), other = random.uniform(0, 1);
        const auto share = [=](Index s) { return s % 2 == 0 ? even : other; };
        const double low = edge_of_own(scene, share);
        const auto stepper = imex(scene, low, share);
        const double certified = stepper->limit().certified;
        CHECK(certified <= low * (1 + 1e-6));
        CHECK(certified >= 0.98 * low);
        const ImexMatrices matrices(scene, low, share);
        const auto edge = static_cast<double>(matrices.edge(2 * static_cast<Real>(low)));
        CHECK(edge <= low * (1 + 1e-5));
        const auto rises = [&](double h) {
            return climb(random, scene, h, forced, 500,
                         [&](AnyState& state, const RealMatrix& F) {
                             return book_imex(*stepper, scene, matrices, state, h, F);
                         })
                .rises;
        };
        CHECK_FALSE(rises(certified));
        CHECK_FALSE(rises(certified / 3));
        above = above || rises(1.05 * edge);
    }
    CHECK(above);
}

}  // namespace

TEST_CASE("imex: no step gains energy at the step that was wished for, or a third of it",
          "[imex]") {
    for (const Kind& kind : imex_kinds) {
        INFO(kind);
        check_networks(kind);
    }
}

TEST_CASE("imex: hill climbing finds no gain at what is certified, and some above", "[imex]") {
    for (const Kind& kind : imex_kinds) {
        Random random(8820);
        for (const Beside beside : everything) {
            INFO(kind << ", beside " << static_cast<int>(beside));
            for (const LawOf law : laws_of(kind)) {
                if (law <= LawOf::tension_only) check_edge(random, kind, law, beside);
            }
        }
    }
}

}  // namespace taut_test::imex_energy_test
