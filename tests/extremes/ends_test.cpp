// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "../support/analysis.hpp"
#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"

// The ends of double, and of float: what vanishes, overflows or is rounded on the way from a scene
// to its limit. An answer is right there too, or refused by name. Those of long double:
// long_double_test.cpp.

namespace taut_test::ends_test {

using taut::Method;

namespace {

/// The limit of one mode, from [T9] and [T10] in long double, whose range squares stay within.
Real limit_of(Method method, Real k, Real d) {
    if (k == 0 && d == 0) return std::numeric_limits<Real>::infinity();
    if (method != Method::explicit_euler) return 4 / (d + std::sqrt(d * d + 4 * k));
    return d * d < 4 * k ? d / k : 4 / (d + std::sqrt(d * d - 4 * k));
}

Eigen::VectorXd axis(const Kind& kind) { return Eigen::VectorXd::Unit(kind.dim, 0); }

Eigen::VectorXd random_direction(Random& random, const Kind& kind) {
    Eigen::VectorXd d = random_vector(random, kind.dim, -1, 1);
    while (!(d.norm() > 0.1)) d = random_vector(random, kind.dim, -1, 1);
    return d.normalized();
}

/// A pinned particle at the origin, and one of mass m at x.
Scene two_particles(const Kind& kind, const Eigen::VectorXd& x, double m) {
    Scene scene(kind);
    scene.add_particle(0 * axis(kind), 1);
    scene.add_particle(x, m);
    scene.pin(0);
    return scene;
}

/// A length whose square vanishes.
double vanishing(Random& random, const Kind& kind) {
    return kind.single ? log_uniform(random, 1e-26, 1e-15) : log_uniform(random, 1e-167, 1e-150);
}

/// As add_spring measures it: not one ulp off, or a kink would be.
double length_at_rest(const Scene& scene, const AnyState& state, const AnySpring& spring) {
    if (!scene.kind().single) return (state.x.col(spring.b) - state.x.col(spring.a)).norm();
    const Eigen::MatrixXf x = state.x.cast<float>();
    return static_cast<double>((x.col(spring.b) - x.col(spring.a)).norm());
}

void check_contains(const taut::StepLimit<double>& limit, Real truth, double width) {
    CAPTURE(limit.certified, limit.refuted, static_cast<double>(truth));
    CHECK(static_cast<Real>(limit.certified) <= truth);
    CHECK(static_cast<Real>(limit.refuted) >= truth);
    CHECK(static_cast<Real>(limit.certified) >= truth * static_cast<Real>(1 - width));
    CHECK(static_cast<Real>(limit.refuted) <= truth * static_cast<Real>(1 + width));
}

}  // namespace

TEST_CASE("ends: damping whose square vanishes or overflows", "[extremes]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        // Of d0 and of the limit, which must be normal numbers of the scalar.
        const double most = kind.single ? 1e36 : 1e300;
        Random random(1600 + static_cast<std::uint32_t>(kind.dim));
        for (int repeat = 0; repeat < 60; ++repeat) {
            auto scene = two_particles(kind, axis(kind), 0.5);
            const double d0 = scene.rounded(log_uniform(random, 1 / most, most));
            CAPTURE(kind, repeat, d0);
            if (repeat % 2 == 0) scene.add_spring({0, 1, 0, 1});
            scene.set_rayleigh(d0, 0);
            const Analysis springs(scene, scene.initial_state());
            const Matrices bare{Eigen::VectorXd::Ones(1), Eigen::MatrixXd::Constant(1, 1, d0),
                                Eigen::MatrixXd::Zero(1, 1), kind.single};
            // An entry of a matrix is no factor: its square must be a normal number, too.
            const bool in_range = d0 > 1e-150 && d0 < 1e150;
            if (!in_range) {
                const auto message = message_of([&] { (void)Analysis(bare); });
                CHECK(missing(message, {"damping in row 0"}) == "");
            }
            const double width = 1e-12 + 8 * kind.epsilon();
            for (const double tightness : {0.0, 1e-6}) {
                for (const Method method : {Method::explicit_euler, Method::symplectic_euler}) {
                    INFO(name(method) << ", tightness " << tightness);
                    const Real truth = limit_of(method, 0, static_cast<Real>(d0));
                    check_contains(springs.max_step(method, tightness), truth, width);
                    if (in_range)
                        check_contains(Analysis(bare).max_step(method, tightness), truth, width);
                }
                check_contains(scene.any_pose_limit(tightness), 2 / static_cast<Real>(d0), width);
            }
        }
    }
}

TEST_CASE("ends: springs whose squared length vanishes", "[extremes]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Random random(1610 + static_cast<std::uint32_t>(kind.dim));
        for (int repeat = 0; repeat < 200; ++repeat) {
            const double length = vanishing(random, kind);
            auto scene = two_particles(kind, length * random_direction(random, kind), 0.25);
            const double k = random.uniform(1, 100);
            // At rest, stretched, or without rest length: k along the spring, and no more across.
            const double l = scene.initial_state().x.col(1).stableNorm();
            scene.add_spring({0, 1, k, repeat % 3 == 0 ? l : repeat % 3 == 1 ? l / 3 : 0});
            CAPTURE(kind, repeat, length);
            const Real truth = 2 / std::sqrt(4 * static_cast<Real>(k));
            const Analysis analysis(scene, scene.initial_state());
            for (const double tightness : {0.0, 1e-6})
                check_contains(analysis.max_step(Method::symplectic_euler, tightness), truth, 1e-5);
        }
    }
}

TEST_CASE("ends: a damper of any length slows by no more than its factor", "[extremes]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Random random(1620 + static_cast<std::uint32_t>(kind.dim));
        for (int repeat = 0; repeat < 300; ++repeat) {
            CAPTURE(kind, repeat);
            const double length = vanishing(random, kind);
            const double c = random.uniform(1, 100);
            auto scene = two_particles(kind, length * random_direction(random, kind), 1);
            scene.add_spring({0, 1, 0, 1, c});
            auto state = scene.initial_state();
            state.v.col(1) = random_direction(random, kind);
            CHECK(scene.force(state).col(1).norm() <= c * (1 + kind.rounding()));
        }
    }
}

TEST_CASE("ends: nets at rest are certified on both sides of every kink", "[extremes]") {
    for (const Kind& kind : all_kinds()) {
        if (kind.laws == Laws::hookean) continue;
        auto laws = laws_of(kind);
        if (kind.laws == Laws::any) laws = {LawOf::tension_only, LawOf::buckling};
        Random random(1630 + static_cast<std::uint32_t>(kind.dim));
        for (int repeat = 0; repeat < 60; ++repeat) {
            Scene scene(kind);
            Scene stiff({false, kind.dim, Laws::hookean});
            // At, or far from, the origin: there the positions' rounding is the larger one.
            const double off = repeat % 3 == 0 ? 100 : 0;
            for (int i = 0; i < 5; ++i)
                scene.add_particle(random_vector(random, kind.dim, off - 1, off + 1),
                                   random.uniform(0.5, 2));
            const auto state = scene.initial_state();
            for (Index i = 0; i < 5; ++i) stiff.add_particle(state.x.col(i), scene.mass(i));
            for (int a = 0; a < 5; ++a) {
                for (const LawOf law : laws) {
                    auto spring = draw_spring(random, law);
                    spring.a = a;
                    spring.b = (a + 1 + random.below(4)) % 5;
                    spring.rest_length = length_at_rest(scene, state, spring);
                    scene.add_spring(spring);
                    spring.stiffness = scene.rounded(spring.stiffness);
                    spring.stiffness = std::max(spring.stiffness, spring.third);
                    spring.law = LawOf::hookean;
                    spring.rest_length = (state.x.col(a) - state.x.col(spring.b)).norm();
                    stiff.add_spring(spring);
                }
            }
            const Index held = random.below(5);
            scene.pin(held);
            stiff.pin(held);
            const auto k = eigenvalues(exact_matrices(stiff, state.x).scaled(0, 1, 0, false));
            const Real truth = 2 / std::sqrt(k[k.size() - 1]);
            const Analysis analysis(scene, state);
            for (const double tightness : {0.0, 1e-6}) {
                const auto limit = analysis.max_step(Method::symplectic_euler, tightness);
                CAPTURE(kind, repeat, tightness, limit.certified, limit.refuted);
                CHECK(static_cast<Real>(limit.certified) <= truth * (1 + 1e-12L));
                CHECK(limit.refuted >= limit.certified);
                CHECK(static_cast<Real>(limit.refuted) <= truth * 2);
            }
            const auto beyond = static_cast<double>(truth * 1.0001L);
            CHECK_FALSE(analysis.proves(Method::symplectic_euler, beyond));
        }
    }
}

TEST_CASE("ends: explicit Euler at a kink holds on the slack side, too", "[extremes]") {
    const Kind kinds[] = {{false, 1, Laws::any}, {true, 2, Laws::strings}, {true, 3, Laws::any}};
    for (const Kind& kind : kinds) {
        Random random(1640);
        for (int repeat = 0; repeat < 400; ++repeat) {
            auto scene = two_particles(kind, axis(kind), 1);
            const double k = scene.rounded(log_uniform(random, 1, 1e4));
            const double c = scene.rounded(std::sqrt(k) * log_uniform(random, 0.1, 10));
            scene.add_spring({0, 1, k, 1, c, LawOf::tension_only});
            // Without drag a string stretched by an ulp swings sideways: no step is stable.
            const bool drag = kind.dim > 1 || repeat % 2 == 1;
            const double d0 = drag ? random.uniform(kind.dim > 1 ? 0.5 : 0, 1) : 0;
            scene.set_rayleigh(d0, 0);
            auto state = scene.initial_state();
            const double end = repeat % 3 == 0 ? 0 : 2;
            for (Index ulps = random.below(4); ulps > 0; --ulps) {
                double& x = state.x(0, 1);
                x = kind.single ? std::nextafter(static_cast<float>(x), static_cast<float>(end))
                                : std::nextafter(x, end);
            }
            const Real d = static_cast<Real>(c) + static_cast<Real>(d0);
            const Real truth = std::min(limit_of(Method::explicit_euler, 0, d),
                                        limit_of(Method::explicit_euler, static_cast<Real>(k), d));
            const Analysis analysis(scene, state);
            for (const double tightness : {0.0, 1e-6}) {
                const auto limit = analysis.max_step(Method::explicit_euler, tightness);
                CAPTURE(kind, repeat, tightness, limit.certified, static_cast<double>(truth));
                CHECK(static_cast<Real>(limit.certified) <= truth);
                CHECK(static_cast<Real>(limit.refuted) >= truth);
                // Without drag the bound alone cannot tell D − hK⁺ ⪰ 0 from its rounding.
                if (tightness > 0 || drag) CHECK(limit.certified > 0);
            }
        }
    }
}

TEST_CASE("ends: a stepper's own 1/m and d0 stay within the certified step", "[extremes]") {
    for (const bool single : {true, false}) {
        const Kind kind{single, 1, Laws::hookean};
        Random random(1650);
        for (int repeat = 0; repeat < 2000; ++repeat) {
            const double m = 0.1 + random.uniform(0, 3);
            auto scene = two_particles(kind, axis(kind), m);
            const double k = scene.rounded(10 + random.uniform(0, 1000));
            const double d0 =
                repeat % 2 == 0 ? 0 : random.uniform(0, 1) + random.uniform(0, 1) / 3e7;
            scene.add_spring({0, 1, k, 1});
            scene.set_rayleigh(d0, 0);
            CAPTURE(kind, repeat);
            const double inverse = single ? static_cast<double>(1 / static_cast<float>(m)) : 1 / m;
            const Real truth = limit_of(Method::symplectic_euler,
                                        static_cast<Real>(k) * static_cast<Real>(inverse),
                                        static_cast<Real>(scene.rounded(d0)));
            const Analysis analysis(scene, scene.initial_state());
            for (const double tightness : {0.0, 1e-6})
                check_contains(analysis.max_step(Method::symplectic_euler, tightness), truth, 1e-5);
            CHECK(static_cast<Real>(scene.any_pose_limit().certified) <= truth);
            const auto beyond = static_cast<double>(truth * (1 + 1e-15L));
            CHECK_FALSE(analysis.proves(Method::symplectic_euler, beyond));
        }
    }
}

}  // namespace taut_test::ends_test
