// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"

// Brackets narrowed by factorisations, where the truth has a closed form. See proof/limit_test.

namespace taut_test::narrow_test {

using taut::ChainEnds;
using taut::Method;

namespace {

constexpr double tightness = 1e-6;

/// certified ≤ truth ≤ refuted ≤ (1 + tightness)·certified; the truth known to a few ulp.
void check_around(const taut::StepLimit<double>& limit, double truth, double epsilon) {
    INFO(limit.certified << " <= " << truth << " <= " << limit.refuted);
    CHECK(limit.certified <= truth * (1 + 1e-15));
    CHECK(limit.refuted >= truth * (1 - 1e-15));
    CHECK(limit.refuted <= limit.certified * (1 + tightness) * (1 + 10 * epsilon));
    CHECK(limit.certified > 0);
}

double chain_k_max(const taut::ChainOptions& c) {
    const auto n = static_cast<Real>(c.masses);
    const Real pi = std::acos(Real(-1));
    const Real angle = c.ends == ChainEnds::fixed_fixed  ? n * pi / (2 * (n + 1))
                       : c.ends == ChainEnds::fixed_free ? (2 * n - 1) * pi / (2 * (2 * n + 1))
                       : c.ends == ChainEnds::free_free  ? (n - 1) * pi / (2 * n)
                                                         : std::floor(n / 2) * pi / n;
    const Real sine = std::sin(angle);
    return static_cast<double>(4 * static_cast<Real>(c.stiffness) / static_cast<Real>(c.mass) *
                               sine * sine);
}

/// A row of squeezed springs from a pin, each free end with bare dampers across the row: K is
/// indefinite, no damping commutes with it, and 4M − 2hD − h²K ≻ 0 may hold again at large h.
Scene squeezed_row(Random& random, const Kind& kind) {
    Scene scene(kind);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(kind.dim);
    Index last = scene.add_particle(x, 1);
    scene.pin(last);
    const Index count = 1 + random.below(3);
    for (Index i = 0; i < count; ++i) {
        const double k = log_uniform(random, 0.5, 2);
        const double m = log_uniform(random, 0.5, 2);
        const double l = log_uniform(random, 0.005, 0.05);
        x[0] += l;
        const Index next = scene.add_particle(x, m);
        scene.add_spring({last, next, k, 1});
        for (int axis = 1; axis < kind.dim; ++axis) {
            const Index anchor = scene.add_particle(x + Eigen::VectorXd::Unit(kind.dim, axis), 1);
            scene.pin(anchor);
            scene.add_spring({next, anchor, 0, 1, random.uniform(2.2, 4) * std::sqrt(k / l * m)});
        }
        last = next;
    }
    return scene;
}

}  // namespace

TEST_CASE("narrow: chains and rings by their closed forms", "[tight]") {
    for (const bool single : {false, true}) {
        const double epsilon = Kind{single}.epsilon();
        for (const ChainEnds ends : {ChainEnds::fixed_fixed, ChainEnds::fixed_free,
                                     ChainEnds::free_free, ChainEnds::ring}) {
            for (const Index masses : {3, 4, 17, 100}) {
                taut::ChainOptions options;
                options.masses = ends == ChainEnds::ring && masses == 100 ? 401 : masses;
                options.ends = ends;
                options.mass = 0.25;
                options.stiffness = 300;
                auto chain = chain_scene(single, 1, options);
                const double k = chain_k_max(options);
                INFO(chain.kind() << ", " << options.masses << " masses, ends "
                                  << static_cast<int>(ends));
                const auto check = [&](Method method, double truth) {
                    const Analysis analysis(chain, chain.initial_state());
                    check_around(analysis.max_step(method, tightness), truth, epsilon);
                };
                check(Method::symplectic_euler, 2 / std::sqrt(k));
                // Rayleigh damping of either kind; k_max decides.
                const double omega = std::sqrt(k);
                for (const auto& [d0, alpha] : {std::pair<double, double>{0.5 * omega, 0},
                                                {0, 0.25 / omega},
                                                {0, 3 / omega},
                                                {0.3 * omega, 1 / omega}}) {
                    INFO("d0 = " << d0 << ", alpha = " << alpha);
                    chain.set_rayleigh(d0, alpha);
                    const double d = d0 + alpha * k;
                    check(Method::symplectic_euler, 4 / (d + std::sqrt(d * d + 4 * k)));
                    const double truth = d * d < 4 * k ? d / k : 4 / (d + std::sqrt(d * d - 4 * k));
                    if (d0 == 0 || truth < 2 / d0) check(Method::explicit_euler, truth);
                }
            }
        }
    }
}

TEST_CASE("narrow: grids of zero rest length by their closed form", "[tight]") {
    for (const auto& [rows, columns] : {std::pair<Index, Index>{2, 5}, {9, 9}, {16, 25}}) {
        INFO(rows << " x " << columns);
        taut::ClothOptions options;
        options.rows = rows;
        options.columns = columns;
        options.bend = 0;
        options.diagonals = false;
        options.pin_corners = false;
        const auto grid = at_zero_length(cloth_scene(options));
        taut::ChainOptions row;
        row.ends = ChainEnds::free_free;
        row.mass = options.mass / static_cast<double>(rows * columns);
        row.stiffness = options.stretch;
        row.masses = rows;
        double k = chain_k_max(row);
        row.masses = columns;
        k += chain_k_max(row);
        // Linear: the same at every pose, and for all of them at once.
        const Analysis analysis(grid, deformed(grid, 1.3, 0.2, 1));
        const double epsilon = Kind{}.epsilon();
        check_around(analysis.max_step(Method::symplectic_euler, tightness), 2 / std::sqrt(k),
                     epsilon);
        check_around(grid.any_pose_limit(tightness), 2 / std::sqrt(k), epsilon);
    }
}

TEST_CASE("narrow: with an indefinite K and dampers across it nothing above the first limit",
          "[tight]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        if (kind.dim == 1) continue;
        Random random(302);
        int again = 0;
        for (int repeat = 0; repeat < 25; ++repeat) {
            const auto scene = squeezed_row(random, kind);
            const auto state = scene.initial_state();
            const Analysis analysis(scene, state);
            const Exact e = exact_matrices(scene, state.x);
            const double truth = definite_limit(e, 1, false) * (1 + 1e-9);
            INFO(kind << ", system " << repeat << " of seed 302, limit " << truth);
            const auto limit = analysis.max_step(Method::symplectic_euler, tightness);
            CHECK(limit.certified > 0);
            CHECK(limit.certified <= truth);
            CHECK(limit.refuted >= truth * (1 - 2e-9));
            for (double h = truth / 2; h < 3 * limit.refuted; h *= 1.25) {
                if (analysis.proves(Method::symplectic_euler, h)) CHECK(h <= truth);
                CHECK(analysis.proves(Method::velocity_verlet, h) ==
                      analysis.proves(Method::symplectic_euler, h));
                // The first condition alone would prove this step.
                again += h > truth && definite_margin(e, h) > 1e-6L;
            }
        }
        CHECK(again > 15);
        // By hand: a spring of 1 N/m at a hundredth of its length, 30 N·s/m across it, 1 kg.
        Scene scene({kind.single, 2, Laws::hookean});
        scene.add_particle(Eigen::Vector2d(0, 0), 1);
        scene.add_particle(Eigen::Vector2d(0.01, 0), 1);
        scene.add_particle(Eigen::Vector2d(0.01, 1), 1);
        scene.add_spring({0, 1, 1, 1});
        scene.add_spring({1, 2, 0, 1, 30});
        scene.pin(0);
        scene.pin(2);
        const Analysis analysis(scene, scene.initial_state());
        const double truth = 4 / (30 + std::sqrt(900.0 - 4 * 99));
        CHECK_THAT(truth, WithinAbs(0.0763, 1e-4));
        CHECK(analysis.max_step(Method::symplectic_euler, tightness).certified <=
              truth * (1 + 1e-6));
        for (const double h : {0.54, 1.0, 1.9})
            CHECK_FALSE(analysis.proves(Method::symplectic_euler, h));
    }
}

// Along x a spring far compressed, which pushes across, and along each other axis one at its
// length: K = k − t there, K⁺ = k, and the certificate of explicit Euler is that of K⁺ [T17].
TEST_CASE("narrow: what compression takes from the stiffness across certifies no explicit step",
          "[proof]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        if (kind.dim == 1) continue;
        Random random(1312);
        for (int repeat = 0; repeat < 40; ++repeat) {
            const double m = log_uniform(random, 0.1, 10), k = log_uniform(random, 1, 1e4);
            const double c = std::sqrt(k * m) * random.uniform(0.01, 0.2);
            Scene scene(kind);
            scene.add_particle(Eigen::VectorXd::Zero(kind.dim), m);
            for (Index i = 0; i < kind.dim; ++i) {
                scene.add_particle(Eigen::VectorXd::Unit(kind.dim, i), 1);
                scene.pin(i + 1);
                if (i == 0) scene.add_spring({0, 1, 0.1 * k, 1 + random.uniform(2, 6), c});
                if (i > 0) scene.add_spring({0, i + 1, k, 1, c});
            }
            INFO(kind << ", repeat " << repeat << " of seed 1312");
            const AnySpring held = scene.springs()[1];
            const auto limit =
                Analysis(scene, scene.initial_state()).max_step(Method::explicit_euler, 1e-3);
            CHECK(limit.certified <= held.damping / held.stiffness);
            CHECK(limit.certified >= 0.99 * held.damping / held.stiffness);
        }
    }
}

}  // namespace taut_test::narrow_test
