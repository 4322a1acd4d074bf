// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/message.hpp"
#include "../support/scene_dense.hpp"
#include "../support/tolerance.hpp"
#include "network_scenes.hpp"

// K, K⁺ and D: against forces, against what they are written as, and as a pattern.

namespace taut_test::tangent_test {

using namespace taut::matrices;
namespace {

/// visit(scene, state) of random ones; pins in between, too.
template <class Visit>
void for_each_pose(std::uint32_t seeds, const std::vector<Kind>& kinds, Visit&& visit) {
    for (const Kind& kind : kinds) {
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
            CAPTURE(kind, seed);
            Random random(seed);
            RandomOptions options;
            options.springs = kind.laws == Laws::any ? 9 : 14;
            options.pinned = random.below(4);
            options.dampers = seed % 2 == 0;
            options.rayleigh = seed % 3 != 1;
            auto scene = random_scene(random, kind, options);
            if (options.pinned > 0) scene.pin(6);
            visit(scene, random_state(random, scene));
        }
    }
}

Eigen::VectorXd energy_gradient(const Scene& scene, AnyState state, double h) {
    Eigen::VectorXd gradient(state.x.size());
    for (Index j = 0; j < state.x.size(); ++j) {
        double& entry = state.x.data()[j];
        const double before = entry;
        entry = before + h;
        const double up = scene.potential_energy(state);
        entry = before - h;
        gradient[j] = (up - scene.potential_energy(state)) / (2 * h);
        entry = before;
    }
    return gradient;
}

}  // namespace

TEST_CASE("tangent: force is -grad(energy), K is -df/dx and D is -df/dv", "[network]") {
    std::vector<Kind> kinds;
    for (const Kind& kind : tangent_kinds()) {
        if (!kind.single) kinds.push_back(kind);
    }
    for_each_pose(10, kinds, [](const Scene& scene, const AnyState& state) {
        const double difference = Tolerance<double>::difference;
        const double h = 1e-5;
        auto still = state;
        still.v.setZero();
        const auto f = flat_force(scene, still);
        CHECK(distance(f, -energy_gradient(scene, still, h)) < difference * (1 + largest(f)));
        const auto free = free_dofs(scene);
        const auto KD = assembled(scene, state, {K, D});
        const double size = 1 + largest(KD[0]);
        const auto by_x = difference_quotient(scene, still, false, h);
        CHECK(distance(KD[0], by_x(free, free)) < difference * size);
        // Forces are linear in v: any step will do, about any velocity.
        const auto by_v = difference_quotient(scene, state, true, 0.5);
        CHECK(distance(KD[1], by_v(free, free)) <= scene.kind().rounding() * (size + largest(f)));
    });
}

TEST_CASE("tangent: assemble is the sum of dense M, K, K+ and D, and clears what was there",
          "[network]") {
    for_each_pose(3, tangent_kinds(), [](const Scene& scene, const AnyState& state) {
        const auto dense = dense_matrices(scene, state);
        const auto free = free_dofs(scene);
        const std::vector<taut::Combination> sums = {
            M, K, K_plus, D, M + 0.5 * D + 0.25 * K_plus, 3 * M + 2 * D - 0.5 * K};
        const auto matrices = assembled(scene, state, sums);
        double rounding = scene.kind().rounding() * (largest(dense.K) + largest(dense.M));
        if (scene.kind().single) {  // a short spring magnifies rounding by rest length over length
            double shortest = 1;
            for (const auto& s : scene.springs())
                shortest = std::min(shortest, (state.x.col(s.a) - state.x.col(s.b)).norm());
            rounding /= shortest;
        }
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const auto& c = sums[i];
            const Eigen::MatrixXd expected = c.mass() * dense.M + c.damping() * dense.D +
                                             c.stiffness() * dense.K + c.projected() * dense.K_plus;
            CHECK(distance(matrices[i], expected(free, free)) <= rounding);
            CHECK(distance(matrices[i], matrices[i].transpose()) <= rounding);
        }
    });
}

TEST_CASE("tangent: linearize has those matrices, the masses, and the force without velocity",
          "[network]") {
    for_each_pose(5, linearized_kinds(), [](const Scene& scene, const AnyState& state) {
        const auto linear = linearization(scene, state);
        const auto KD = assembled(scene, state, {K, D, M});
        CHECK((linear.K == KD[0]));
        CHECK((linear.D == KD[1]));
        CHECK((linear.mass == KD[2].diagonal()));
        auto still = state;
        still.v.setZero();
        CHECK((linear.load == flat_force(scene, still)(free_dofs(scene))));
    });
}

TEST_CASE("tangent: bad input: what linearize cannot take is named", "[network][bad_input]") {
    for (const Kind& kind : linearized_kinds()) {
        CAPTURE(kind);
        Random random(1);
        auto scene = random_scene(random, kind);
        const auto start = scene.initial_state();
        const auto says = [&](const AnyState& state, const char* problem, const char* where) {
            const auto message = message_of([&] { (void)linearization(scene, state); });
            CHECK(missing(message, {"linearize", problem, where}) == "");
        };
        for (Eigen::MatrixXd AnyState::*part : {&AnyState::x, &AnyState::v}) {
            auto bad = start;
            (bad.*part).conservativeResize(kind.dim, 2);
            says(bad, "8 particles", "");
            bad = start;
            (bad.*part)(0, 2) = std::numeric_limits<double>::quiet_NaN();
            says(bad, "particle 2", "finite");
        }
        for (Index i = 0; i < scene.size(); ++i) scene.pin(i);
        says(start, "none of the 8", "is free");
        scene = Scene(kind);
        says(scene.initial_state(), "none of the 0", "is free");
    }
}

TEST_CASE("tangent: no spring's exceeds its law's bound, nor is K+ negative", "[network]") {
    for_each_pose(5, tangent_kinds(), [](const Scene& scene, const AnyState& state) {
        const auto springs = scene.springs();
        std::size_t s = 0;
        for (const auto& t : tangents(scene, state)) {
            const double rounding = scene.kind().rounding();
            CHECK((t.a == springs[s].a && t.b == springs[s].b));
            CHECK(t.damping == springs[s++].damping);
            CHECK(std::max(t.axial, t.transverse) <= t.bound * (1 + rounding));
            CHECK(t.plus_axial == std::max(t.axial, 0.0));
            CHECK(t.plus_transverse == std::max(t.transverse, 0.0));
            CHECK_THAT(t.d.norm(), WithinAbs(1, rounding));
        }
        CHECK(s == springs.size());
    });
}

TEST_CASE("tangent: K+ of a spring is the nearest matrix to K without negative eigenvalues",
          "[network]") {
    for (const Kind& kind : tangent_kinds()) {
        for (const LawOf law : laws_of(kind)) {
            Random random(2003);
            for (int trial = 0; trial < 40; ++trial) {
                CAPTURE(kind, static_cast<int>(law), trial);
                Scene scene(kind);
                for (int i = 0; i < 2; ++i)
                    scene.add_particle(random_vector(random, kind.dim, -1, 1), 1);
                auto spring = draw_spring(random, law);
                spring.rest_length = random.uniform(0, 2);
                scene.add_spring(spring);
                scene.pin(0);
                const auto blocks = assembled(scene, scene.initial_state(), {K, K_plus});
                CHECK((blocks[0] == blocks[0].transpose()));
                const auto eigen = symmetric_modes(blocks[0]);
                const Eigen::MatrixXd nearest = eigen.vectors *
                                                eigen.values.cwiseMax(0).asDiagonal() *
                                                eigen.vectors.transpose();
                const auto t = tangents(scene, scene.initial_state())[0];
                const double size = std::max(std::abs(t.axial), std::abs(t.transverse));
                CHECK(distance(blocks[1], nearest) <= kind.rounding() * size);
            }
        }
    }
}

TEST_CASE("tangent: Rayleigh's D is d0 M + alpha K+, and semi-definite at crumpled poses",
          "[network]") {
    for (const Kind& kind : tangent_kinds()) {
        if (kind.single) continue;
        for (std::uint32_t seed = 1; seed <= 20; ++seed) {
            CAPTURE(kind, seed);
            Random random(seed);
            RandomOptions options;
            options.rayleigh = true;
            const auto scene = random_scene(random, kind, options);
            auto state = random_state(random, scene);
            state.x *= 0.4;  // most springs are compressed
            const auto of = assembled(scene, state, {D, K, K_plus, M});
            const double rounding = kind.rounding() * largest(of[2]);
            CHECK(distance(of[0], 0.25 * of[3] + 0.0078125 * of[2]) <= rounding);
            CHECK(least_eigenvalue(of[0] - 0.25 * of[3]) >= -rounding);
            CHECK(least_eigenvalue(of[2]) >= -rounding);
            CHECK(least_eigenvalue(of[2] - of[1]) >= -rounding);
            if (kind.dim > 1) CHECK(least_eigenvalue(of[1]) < 0);  // the pose is a hard one
        }
    }
}

TEST_CASE("tangent: at rest and 1e-8 off it, force and tangent are those of the rest pose",
          "[network]") {
    for (int dim = 1; dim <= 3; ++dim) {
        CAPTURE(dim);
        Random random(4);
        Scene scene({false, dim, Laws::any});
        const auto x = random_points(random, dim, 6, -1, 1);
        for (int i = 0; i < 6; ++i) scene.add_particle(x.col(i), 1);
        for (int i = 0; i < 6; ++i) {
            const int next = (i + 1) % 6;
            scene.add_spring({i, next, 100, (x.col(next) - x.col(i)).norm()});
        }
        auto state = scene.initial_state();
        CHECK(largest(scene.force(state)) <= 1e-13);
        const auto at_rest = assembled(scene, state, {K})[0];
        const auto u = random_points(random, dim, 6, -1e-8, 1e-8);
        state.x += u;
        const double difference = 100 * Tolerance<double>::difference;
        CHECK(distance(flat_force(scene, state), -at_rest * flat(u)) < difference * largest(u));
        CHECK(distance(assembled(scene, state, {K})[0], at_rest) < difference);
    }
}

TEST_CASE("tangent: a spring of zero length pulls with nothing and is k*I stiff", "[network]") {
    for (const Kind& kind : tangent_kinds()) {
        for (const double rest_length : {0.0, 1.0}) {
            CAPTURE(kind, rest_length);
            Scene scene(kind);
            const Eigen::VectorXd place = Eigen::VectorXd::Ones(kind.dim);
            scene.add_particle(place, 1);
            scene.add_particle(place, 2);
            scene.add_spring({0, 1, 50, rest_length, 3});
            scene.set_rayleigh(0, 0.5);
            auto state = scene.initial_state();
            CHECK(largest(scene.force(state)) == 0);
            CHECK(scene.potential_energy(state) == 25 * rest_length);
            const auto KD = assembled(scene, state, {K, D});
            const Eigen::MatrixXd one = 50 * Eigen::MatrixXd::Identity(kind.dim, kind.dim);
            Eigen::MatrixXd expected(2 * kind.dim, 2 * kind.dim);
            expected << one, -one, -one, one;
            CHECK((KD[0] == expected));
            // Rayleigh damping takes alpha times that tangent; the damper has no direction.
            CHECK((KD[1] == 0.5 * expected));
            state.v.col(1).setOnes();
            CHECK((flat_force(scene, state) == -0.5 * expected * flat(state.v)));
        }
    }
}

TEST_CASE("tangent: duplicate springs add up", "[network]") {
    for (const Kind& kind : tangent_kinds()) {
        CAPTURE(kind);
        Random random(9);
        Scene twice(kind);
        for (int i = 0; i < 2; ++i) twice.add_particle(random_vector(random, kind.dim, -1, 1), 1);
        Scene once = twice;
        twice.add_spring({0, 1, 32, 1, 1});
        twice.add_spring({1, 0, 64, 1, 2});
        once.add_spring({0, 1, 96, 1, 3});
        const auto state = random_state(random, twice);
        const double rounding = 100 * kind.rounding();
        CHECK(distance(twice.force(state), once.force(state)) <= rounding);
        const auto a = assembled(twice, state, {K, D});
        const auto b = assembled(once, state, {K, D});
        CHECK(distance(a[0], b[0]) <= rounding);
        CHECK(distance(a[1], b[1]) <= rounding);
    }
}

}  // namespace taut_test::tangent_test
