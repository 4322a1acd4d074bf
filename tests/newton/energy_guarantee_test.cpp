// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "../support/catch.hpp"
#include "convex_scene.hpp"

namespace taut_test::energy_guarantee_test {

namespace {

using Real = long double;

constexpr Kind kinds[] = {{false, 1}, {false, 2}, {false, 3}, {true, 1}, {true, 2}, {true, 3}};

/// What a scene is made of.
struct Draw {
    double softest = 0, stiffest = 9;  ///< powers of ten, N/m
    bool one_of_1e20 = false;
    double nearest = -1, farthest = -1;  ///< powers of ten, m, from the origin, unless negative
};

double power_of_ten(Random& random, double low, double high) {
    return std::pow(10, random.uniform(low, high));
}

/// Strings of all laws between random particles, every other time with dampers and Rayleigh
/// damping; pins at rest.
ConvexScene draw_scene(Random& random, const Kind& kind, const Draw& draw) {
    const auto rounded = [&](auto points) {
        return kind.single ? decltype(points)(points.template cast<float>().template cast<double>())
                           : points;
    };
    const Index particles = 6;
    ConvexScene scene{};
    scene.single = kind.single;
    scene.dim = kind.dim;
    scene.mass.resize(particles);
    for (Index i = 0; i < particles; ++i) {
        random_vector(random, kind.dim, -1, 1);
        scene.mass[i] = random.uniform(0.01, 2);
    }
    const bool damped = random.below(2) == 0;
    for (const Pull pull : {Pull::linear, Pull::bungee, Pull::yielding}) {
        for (Index s = 0; s < 4; ++s) {
            const Index a = random.below(particles);
            const Index b = (a + 1 + random.below(particles - 1)) % particles;
            ConvexString string{a, b, pull, 0, 1, 0, 0};
            string.stiffness = power_of_ten(random, draw.softest, draw.stiffest);
            if (kind.single) string.stiffness = static_cast<float>(string.stiffness);
            if (pull != Pull::linear) string.width = random.uniform(0.01, 1);
            string.rest_length = random.uniform(0, 1.5);
            string.damping = damped ? random.uniform(0, 10) : 0;
            scene.strings.push_back(string);
        }
    }
    while (scene.pinned < random.below(3)) ++scene.pinned;
    scene.gravity = random_vector(random, kind.dim, -10, 10);
    if (damped) {
        scene.mass_proportional = random.uniform(0, 1);
        scene.stiffness_proportional = random.uniform(0, 0.01);
    }
    AnyState& state = scene.state;
    state.x = random_points(random, kind.dim, particles, -1, 1);
    state.v = random_points(random, kind.dim, particles, -1, 1);
    state.v *= power_of_ten(random, -1, 2);
    if (draw.farthest >= 0) {
        const double far = power_of_ten(random, draw.nearest, draw.farthest);
        state.x.colwise() += far * random_vector(random, kind.dim, 0.5, 1);
    }
    state.v.leftCols(scene.pinned).setZero();
    state.x = rounded(state.x);
    state.v = rounded(state.v);
    if (draw.one_of_1e20) {
        const double l = (state.x.col(4) - state.x.col(5)).norm();
        const double rest = (random.below(2) == 0 ? 1 : 1.05) * l;
        scene.strings.push_back({4, 5, Pull::linear, kind.single ? double(1e20F) : 1e20, 1,
                                 kind.single ? double(static_cast<float>(rest)) : rest, 0});
    }
    scene.push = random_points(random, kind.dim, particles, -5, 5);
    return scene;
}

struct Weighed {
    Real own = 0;       // kinetic and elastic energy, J
    Real rounding = 0;  // R of [T24], J
};

/// From [T24], with nothing of the library's sums in it.
Weighed weigh(const ConvexScene& scene, const Kind& kind, const AnyState& state) {
    const auto x = state.x.cast<Real>().eval();
    const Real g = scene.gravity.cast<Real>().norm();
    Weighed sum;
    const auto blur = [&](Index i) {
        return 4 * static_cast<Real>(kind.epsilon()) * x.col(i).norm();
    };
    for (Index i = scene.pinned; i < scene.mass.size(); ++i) {
        sum.own += scene.mass[i] / 2 * state.v.col(i).cast<Real>().squaredNorm();
        sum.rounding += scene.mass[i] * g * blur(i);
    }
    for (const ConvexString& string : scene.strings) {
        const LawAt law = law_at(string, (x.col(string.b) - x.col(string.a)).norm());
        const Real stretch = blur(string.a) + blur(string.b);
        sum.own += law.energy;
        sum.rounding += law.tension * stretch + law.bound * stretch * stretch / 2;
    }
    return sum;
}

/// Whether a step from the scene's state keeps the promise.
bool keeps(const ConvexScene& scene, const Kind& kind, const AnyState& after, double tolerance) {
    const Weighed start = weigh(scene, kind, scene.state);
    const Weighed end = weigh(scene, kind, after);
    Real work = 0;
    for (Index i = scene.pinned; i < scene.mass.size(); ++i) {
        const auto f = (scene.gravity * scene.mass[i] + scene.push.col(i)).cast<Real>();
        work += f.dot((after.x.col(i).cast<Real>() - scene.state.x.col(i).cast<Real>()));
    }
    const Real stake = start.own + std::abs(work);
    return end.own - start.own - work <=
           tolerance * stake + start.rounding + end.rounding +
               64 * static_cast<Real>(kind.epsilon()) * (stake + end.own);
}

/// @returns how many of a hundred steps are solved
int solved(const Kind& kind, const Draw& draw) {
    const int count = 500;
    int converged = 0;
    for (std::uint32_t seed = 1; seed <= count; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const auto scene = draw_scene(random, kind, draw);
        const double h = power_of_ten(random, -4, 2);
        auto state = scene.state;
        const taut::Report report = convex_step(scene, h, state);
        if (report) {
            ++converged;
            CHECK(keeps(scene, kind, state, 1e-6));
        } else {
            CHECK(report.residual > (report.status == taut::Status::not_converged ? 1e-6 : -1));
            CHECK(state == scene.state);
        }
    }
    return 100 * converged / count;
}

}  // namespace

TEST_CASE("energy_guarantee: a converged implicit step keeps the promise of [T24]",
          "[newton][slow]") {
    for (const Kind kind : kinds) {
        const bool wide = !kind.single;
        INFO(kind);
        CHECK(solved(kind, {0, 9, false}) >= (wide ? 96 : 50));
        // 23 decades of stiffness.
        CHECK(solved(kind, {-3, 20, false}) >= 10);
        CHECK(solved(kind, {0, 3, true}) >= 50);
        // Far from the origin; there with one spring of 1e20 N/m.
        CHECK(solved(kind, wide ? Draw{0, 6, false, 3, 9} : Draw{0, 3, false, 1, 5}) >= 99);
        CHECK(solved(kind, wide ? Draw{0, 3, true, 3, 9} : Draw{0, 3, true, 1, 5}) >= 10);
    }
}

TEST_CASE("energy_guarantee: one linearised solve does not keep it", "[newton]") {
    for (const Kind kind : kinds) {
        int broken = 0;
        for (std::uint32_t seed = 1; seed <= 100; ++seed) {
            Random random(seed);
            const auto scene = draw_scene(random, kind, {});
            auto state = scene.state;
            const double anything = 1e30;
            broken += !convex_step(scene, power_of_ten(random, -4, 2), state, anything) ||
                      !keeps(scene, kind, state, 1e-6);
        }
        INFO(kind);
        CHECK(broken > 5);
    }
}

TEST_CASE("energy_guarantee: a string of 1e20 N/m excuses no particle but its own", "[newton]") {
    const int count = 200;
    int converged = 0;
    for (std::uint32_t seed = 1; seed <= count; ++seed) {
        Random random(seed);
        auto scene = draw_scene(random, {false, 3}, {1, 2});
        const double h = power_of_ten(random, -3, 0);
        AnyState alone = scene.state;
        INFO("seed " << seed << ", h " << h);
        REQUIRE(convex_step(scene, h, alone, 1e-11));

        // The same with a pair beside it that nothing joins to it.
        const auto widen = [&](Eigen::MatrixXd& of, double low, double high) {
            of.conservativeResize(Eigen::NoChange, 8);
            of.rightCols(2) = random_points(random, 3, 2, low, high);
        };
        widen(scene.state.x, 2, 5);
        widen(scene.state.v, -1, 1);
        widen(scene.push, 0, 0);
        scene.mass.conservativeResize(8);
        scene.mass.tail(2).setOnes();
        scene.strings.push_back({6, 7, Pull::linear, 1e20, 1, 0, 0});
        AnyState beside = scene.state;
        if (!convex_step(scene, h, beside)) continue;
        ++converged;
        CHECK((beside.v.leftCols(6) - alone.v).cwiseAbs().maxCoeff() <=
              1e-3 * alone.v.cwiseAbs().maxCoeff());
    }
    CHECK(converged >= count / 2);
}

TEST_CASE("energy_guarantee: float reaches what its rounding admits", "[newton]") {
    Random random(5);
    auto scene = draw_scene(random, {true, 2}, {1, 2});
    for (int i = 0; i < 5; ++i) {
        const taut::Report report = convex_step(scene, 0.05, scene.state, 1e-12);  // out of reach
        CHECK(report);
        CHECK(report.residual < 1e-3);
    }
}

TEST_CASE("energy_guarantee: the work of moving pins and constraints is no gain", "[newton]") {
    for (const Kind kind : kinds) {
        for (std::uint32_t seed = 1; seed <= 20; ++seed) {
            INFO(kind << ", seed " << seed);
            Random random(seed);
            auto scene = draw_scene(random, kind, {1, 2});
            scene.pinned = 2;
            scene.state.v = random_points(random, kind.dim, 6, -1, 1);
            scene.state.v.leftCols(2) *= 20;
            const Held held{3, 5, random_vector(random, kind.dim, 1, 2),
                            random_vector(random, kind.dim, -20, 20)};
            auto state = scene.state;
            REQUIRE(convex_step(scene, 0.1, state, 1e-6, &held));
            CHECK(weigh(scene, kind, state).own > weigh(scene, kind, scene.state).own);
        }
    }
}

}  // namespace taut_test::energy_guarantee_test
