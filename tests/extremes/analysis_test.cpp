// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/analysis.hpp"
#include "../support/catch.hpp"
#include "../support/methods.hpp"
#include "extreme_scene.hpp"

// Masses, stiffnesses and dampings further apart than any scene's: an answer may be useless, but it
// is a number, and never a false certificate.

namespace taut_test::extreme_analysis_test {

using taut::Method;

namespace {

void check_numbers(const taut::StepLimit<double>& limit) {
    for (const double number : {limit.certified, limit.refuted, limit.certified_up_to,
                                limit.admitted_growth, limit.growth_rate})
        CHECK_FALSE(std::isnan(number));
    CHECK(limit.certified >= 0);
    CHECK(limit.refuted >= limit.certified);
}

/// Whether the analysis takes a mass or a stiffness.
bool in_range(double size) { return size == 0 || (size >= 0x1p-500 && size <= 0x1p500); }

/// Whether 4M − 2hD − h²K is definite at every part of h, in long double.
bool safe(const Exact& e, double h) {
    for (const double part : {1.0, 0.5, 0.01}) {
        const Real t = static_cast<Real>(part) * static_cast<Real>(h);
        const RealMatrix S = e.scaled(4, -t * t, -2 * t, false);
        if (!(eigenvalues(S)[0] >= -1e-15L * S.cwiseAbs().maxCoeff())) return false;
    }
    return true;
}

/// visit(method, tightness) of each that is limited by the scene.
template <class Visit>
void for_each_effort(Visit&& visit) {
    for (const double tightness : {0.0, 1e-6}) {
        for (const Method method : limited_methods) {
            INFO(name(method) << ", tightness " << tightness);
            visit(method, tightness);
        }
    }
}

}  // namespace

TEST_CASE("extremes: masses and stiffnesses over 27 decades in one system", "[extremes][slow]") {
    for (int dim = 1; dim <= 3; ++dim) {
        Random random(1500 + static_cast<std::uint32_t>(dim));
        for (int repeat = 0; repeat < 60; ++repeat) {
            CAPTURE(dim, repeat);
            const auto scene = extreme_scene(random, {false, dim, Laws::hookean}, repeat % 2 == 1);
            const auto state = scene.initial_state();
            const Exact e = exact_matrices(scene, state.x);
            const Analysis analysis(scene, state);
            for_each_effort([&](Method method, double tightness) {
                const auto limit = analysis.max_step(method, tightness);
                CAPTURE(limit.certified, limit.refuted);
                check_numbers(limit);
                if (!std::isfinite(limit.certified)) return;
                if (method != Method::explicit_euler) {
                    CHECK(limit.certified > 0);
                    if (method != Method::implicit_euler) CHECK(safe(e, limit.certified));
                    return;
                }
                // Both conditions of [T17], its second with the true K.
                const Real h = static_cast<Real>(limit.certified);
                if (h == 0) return;
                const RealMatrix first = e.scaled(0, -h, 1, true);
                const RealMatrix second = e.scaled(4, h * h, -2 * h, false);
                CHECK(eigenvalues(first)[0] >= -1e-14L * first.cwiseAbs().maxCoeff());
                CHECK(eigenvalues(second)[0] >= -1e-14L * second.cwiseAbs().maxCoeff());
            });
            for (const double tightness : {0.0, 1e-6}) {
                const auto any = scene.any_pose_limit(tightness);
                check_numbers(any);
                CHECK(any.certified > 0);
                if (std::isfinite(any.certified)) CHECK(safe(e, any.certified));
            }
            CHECK(taut::count_zero_modes(analysis.in_double()) >= 0);
            const auto k_max = analysis.stiffness_spectrum().k_max;
            CHECK(k_max.upper >= k_max.lower);
            const RealVector k = eigenvalues(e.scaled(0, 1, 0, true));
            CHECK(static_cast<Real>(k_max.upper) >= k[e.size() - 1] * (1 - 1e-17L));
            for (const double h : {1e-12, 1e-3, 1e6}) {
                CHECK_FALSE(std::isnan(analysis.max_stiffness_scale(Method::symplectic_euler, h)));
                CHECK_FALSE(std::isnan(analysis.min_mass_scale(Method::symplectic_euler, h)));
            }
        }
    }
}

TEST_CASE("extremes: numbers near the ends of double", "[extremes]") {
    for (const double k : {1e-151, 1e-150, 1e-100, 1.0, 1e100, 1e150, 1e151}) {
        for (const double m : {1e-151, 1e-150, 1.0, 1e150, 1e151}) {
            for (const double c : {0.0, 1e-151, 1e-150, 1.0, 1e150, 1e151}) {
                CAPTURE(k, m, c);
                Scene scene({false, 3, Laws::hookean});
                scene.add_particle(Eigen::Vector3d(0, 0, 0), m);
                scene.add_particle(Eigen::Vector3d(1, 0, 0), m);
                scene.add_particle(Eigen::Vector3d(1, 2, 0), 1);
                scene.add_spring({0, 1, k, 1, c});
                scene.add_spring({1, 2, 1, 2});
                const auto state = scene.initial_state();
                if (!in_range(k) || !in_range(m) || !in_range(c)) {
                    CHECK(scene.any_pose_limit().certified == 0);
                    CHECK_THROWS_WITH(Analysis(scene, state),
                                      ContainsSubstring(!in_range(m)   ? "mass of particle 0"
                                                        : !in_range(k) ? "stiffness of spring 0"
                                                                       : "damping of spring 0"));
                    continue;
                }
                const Analysis analysis(scene, state);
                // An axis of the stiff spring: h² 2k/m + 2h 2c/m ≤ 4 is necessary.
                const auto possible = [&](double h) {
                    const Real t = static_cast<Real>(h);
                    return (t * t * 2 * static_cast<Real>(k) + 4 * t * static_cast<Real>(c)) /
                               static_cast<Real>(m) <=
                           4 * (1 + 1e-12L);
                };
                for_each_effort([&](Method method, double tightness) {
                    const auto limit = analysis.max_step(method, tightness);
                    check_numbers(limit);
                    if (method != Method::implicit_euler)
                        CHECK((limit.certified == 0 || possible(limit.certified)));
                });
                for (const double tightness : {0.0, 1e-6}) {
                    const auto any = scene.any_pose_limit(tightness);
                    check_numbers(any);
                    CHECK((any.certified == 0 || possible(any.certified)));
                }
                for (const double h : {1e-200, 1e-3, 1e100}) {
                    if (analysis.proves(Method::symplectic_euler, h)) CHECK(possible(h));
                }
            }
        }
    }
}

TEST_CASE("extremes: bare matrices near the ends of double", "[extremes]") {
    for (const double k : {1e-151, 1e-150, 1.0, 1e150, 1e151}) {
        for (const double m : {1e-151, 1e-150, 1.0, 1e150, 1e151}) {
            CAPTURE(k, m);
            Eigen::Matrix2d K;
            K << 2 * k, -k, -k, 2 * k;
            const Matrices matrices{Eigen::Vector2d(m, m), {}, K};
            if (!in_range(k) || !in_range(m)) {
                CHECK_THROWS_WITH(
                    Analysis(matrices),
                    ContainsSubstring(in_range(k) ? "mass in row 0" : "stiffness in row 0"));
                continue;
            }
            const Analysis analysis(matrices);
            for_each_effort([&](Method method, double tightness) {
                const auto limit = analysis.max_step(method, tightness);
                check_numbers(limit);
                if (method == Method::implicit_euler) return;
                const Real h = static_cast<Real>(limit.certified);
                CHECK((h == 0 || h * h * 3 * static_cast<Real>(k) / static_cast<Real>(m) <=
                                     4 * (1 + 1e-12L)));
            });
        }
    }
}

TEST_CASE("extremes: one particle, one spring, exact to the last digit but a few", "[extremes]") {
    Random random(1510);
    for (int repeat = 0; repeat < 300; ++repeat) {
        const double k = log_uniform(random, 1e-12, 1e15);
        const double m = log_uniform(random, 1e-9, 1e9);
        CAPTURE(repeat, k, m);
        Scene scene({false, 1, Laws::hookean});
        for (const double x : {0, 1}) scene.add_particle(Eigen::VectorXd::Constant(1, x), m);
        scene.add_spring({0, 1, k, 1});
        scene.pin(0);
        const auto limit = scene.limit(Method::symplectic_euler, scene.initial_state());
        const Real truth = 2 / std::sqrt(static_cast<Real>(k) / static_cast<Real>(m));
        CHECK(static_cast<Real>(limit.certified) <= truth);
        CHECK(static_cast<Real>(limit.refuted) >= truth);
        CHECK(limit.refuted <= limit.certified * (1 + 1e-12));
    }
}

TEST_CASE("extremes: lengths whose square overflows are refused by name", "[extremes]") {
    for (const double far : {1e149, 1e151, 1e306}) {
        for (const double rest : {1.0, 1e151}) {
            CAPTURE(far, rest);
            Scene scene({false, 3, Laws::hookean});
            scene.add_particle(Eigen::Vector3d(0, 0, 0), 1);
            scene.add_particle(Eigen::Vector3d(-far, 4, 7), 1e-3);
            scene.add_spring({0, 1, 1e10, rest});
            const auto state = scene.initial_state();
            if (far > 1e150 || rest > 1e150) {
                CHECK_THROWS_WITH(scene.limit(Method::symplectic_euler, state),
                                  ContainsSubstring(far > 1e150 ? "position of particle 1"
                                                                : "rest length of spring 0"));
                continue;
            }
            const auto limit = scene.limit(Method::symplectic_euler, state);
            check_numbers(limit);
            CHECK(limit.certified > 0);
            CHECK(limit.certified <= scene.any_pose_limit().refuted);
        }
    }
}

TEST_CASE("extremes: far from the origin a certified step is as safe as near it", "[extremes]") {
    Random random(1521);
    for (int repeat = 0; repeat < 20; ++repeat) {
        CAPTURE(repeat);
        const auto scene = extreme_scene(random, {false, 2, Laws::hookean}, false);
        auto far = scene.initial_state();
        far.x.array() += 134217728;  // 2^27 m; places keep 26 bits behind the point
        auto back = far;
        back.x.array() -= 134217728;
        CHECK_THAT(scene.limit(Method::symplectic_euler, far).certified,
                   WithinRel(scene.limit(Method::symplectic_euler, back).certified, 1e-12));
    }
}

TEST_CASE("extremes: float and double agree on the analysis of one scene", "[extremes]") {
    for (int dim = 1; dim <= 3; ++dim) {
        for (std::uint32_t seed = 1522; seed < 1562; ++seed) {
            CAPTURE(dim, seed);
            Random random(seed);
            const auto narrow = extreme_scene(random, {true, dim, Laws::hookean}, false);
            const auto start = narrow.initial_state();
            Scene wide({false, dim, Laws::hookean});
            for (Index i = 0; i < narrow.size(); ++i) {
                wide.add_particle(start.x.col(i), narrow.mass(i));
                if (narrow.is_pinned(i)) wide.pin(i);
            }
            for (const auto& spring : narrow.springs()) wide.add_spring(spring);
            const auto a = narrow.limit(Method::symplectic_euler, start);
            const auto b = wide.limit(Method::symplectic_euler, start);
            CHECK(a.certified <= b.certified);  // rounded down, never up
            CHECK(a.refuted >= b.refuted);
            CHECK_THAT(a.certified, WithinRel(b.certified, 1e-6));
        }
    }
}

}  // namespace taut_test::extreme_analysis_test
