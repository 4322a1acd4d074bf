// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/any_pose.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/methods.hpp"
#include "extreme_system.hpp"

// Masses, stiffnesses and dampings further apart than any scene's: an answer may be useless, but it
// is a number, and never a false certificate.

namespace taut_test::extreme_analysis_test {

using taut::Method;
using taut::Stability;

namespace {

template <class Scalar>
void check_numbers(const taut::StepLimit<Scalar>& limit) {
    CHECK_FALSE(std::isnan(limit.certified));
    CHECK_FALSE(std::isnan(limit.refuted));
    CHECK_FALSE(std::isnan(limit.certified_up_to));
    CHECK_FALSE(std::isnan(limit.admitted_growth));
    CHECK_FALSE(std::isnan(limit.growth_rate));
    CHECK(limit.certified >= 0);
    CHECK(limit.refuted >= limit.certified);
}

/// Whether the analysis takes a mass or a stiffness.
bool in_range(double size) { return size == 0 || (size >= 0x1p-500 && size <= 0x1p500); }

/// Whether stiffness does not limit the method's step.
bool stable_everywhere(Method method) { return method == Method::implicit_euler; }

/// Whether 4M − 2hD − h²K is definite at every part of h, in long double.
bool safe(const Exact& e, double h) {
    for (const double part : {1.0, 0.5, 0.01}) {
        const Real t = static_cast<Real>(part) * static_cast<Real>(h);
        const RealMatrix S = e.scaled(4, -t * t, -2 * t, false);
        if (!(eigenvalues(S)[0] >= -1e-15L * S.cwiseAbs().maxCoeff())) return false;
    }
    return true;
}

}  // namespace

TEMPLATE_TEST_CASE("extremes: masses and stiffnesses over 27 decades in one system",
                   "[extremes][slow]", (std::integral_constant<int, 1>),
                   (std::integral_constant<int, 2>), (std::integral_constant<int, 3>)) {
    constexpr int Dim = TestType::value;
    Random random(1500 + Dim);
    for (int repeat = 0; repeat < 60; ++repeat) {
        const auto system = extreme_system<double, Dim>(random, repeat % 2 == 1);
        const auto state = system.initial_state();
        const Exact e = exact_matrices(system, state.x);
        const Stability<double> stability(system, state);
        for (const double tightness : {0.0, 1e-6}) {
            INFO("system " << repeat << ", tightness " << tightness);
            for (const Method method : limited_methods) {
                const auto limit = taut::max_step(stability, method, tightness);
                INFO(name(method) << ": " << limit.certified << ", " << limit.refuted);
                check_numbers(limit);
                if (method == Method::explicit_euler) {
                    // Both conditions of [T17], its second with the true K.
                    const Real h = static_cast<Real>(limit.certified);
                    if (h > 0 && std::isfinite(limit.certified)) {
                        const RealMatrix first = e.scaled(0, -h, 1, true);
                        const RealMatrix second = e.scaled(4, h * h, -2 * h, false);
                        CHECK(eigenvalues(first)[0] >= -1e-14L * first.cwiseAbs().maxCoeff());
                        CHECK(eigenvalues(second)[0] >= -1e-14L * second.cwiseAbs().maxCoeff());
                    }
                } else if (!stable_everywhere(method) && std::isfinite(limit.certified)) {
                    CHECK(limit.certified > 0);
                    CHECK(safe(e, limit.certified));
                }
            }
            const auto any = taut::any_pose_limit(system, tightness);
            check_numbers(any);
            CHECK(any.certified > 0);
            if (std::isfinite(any.certified)) CHECK(safe(e, any.certified));
        }
        CHECK(taut::count_zero_modes(stability) >= 0);
        const auto spectrum = stability.stiffness_spectrum();
        CHECK(spectrum.k_max.upper >= spectrum.k_max.lower);
        CHECK(static_cast<Real>(spectrum.k_max.upper) >=
              exact_eigenvalues(e, taut::matrices::K_plus)[e.size() - 1] * (1 - 1e-17L));
        for (const double h : {1e-12, 1e-3, 1e6}) {
            CHECK_FALSE(std::isnan(stability.max_stiffness_scale(Method::symplectic_euler, h)));
            CHECK_FALSE(std::isnan(stability.min_mass_scale(Method::symplectic_euler, h)));
        }
    }
}

TEST_CASE("extremes: numbers near the ends of double", "[extremes]") {
    for (const double k : {1e-151, 1e-150, 1e-100, 1.0, 1e100, 1e150, 1e151}) {
        for (const double m : {1e-151, 1e-150, 1.0, 1e150, 1e151}) {
            for (const double c : {0.0, 1e-151, 1e-150, 1.0, 1e150, 1e151}) {
                taut::SpringSystem<double, 3> system;
                system.add_particle({0, 0, 0}, m);
                system.add_particle({1, 0, 0}, m);
                system.add_particle({1, 2, 0}, 1);
                system.add_spring(0, 1, k, c);
                system.add_spring(1, 2, 1);
                const auto state = system.initial_state();
                INFO("k = " << k << ", m = " << m << ", c = " << c);
                if (!in_range(k) || !in_range(m) || !in_range(c)) {
                    CHECK(taut::any_pose_limit(system).certified == 0);
                    CHECK_THROWS_WITH(Stability<double>(system, state),
                                      ContainsSubstring(!in_range(m)   ? "mass of particle 0"
                                                        : !in_range(k) ? "stiffness of spring 0"
                                                                       : "damping of spring 0"));
                    continue;
                }
                const Stability<double> stability(system, state);
                // An axis of the stiff spring: h² 2k/m + 2h 2c/m ≤ 4 is necessary.
                const auto excess = [&](double h) {
                    const Real t = static_cast<Real>(h);
                    return (t * t * 2 * static_cast<Real>(k) + 4 * t * static_cast<Real>(c)) /
                           static_cast<Real>(m);
                };
                for (const double tightness : {0.0, 1e-6}) {
                    for (const Method method : limited_methods) {
                        INFO(name(method) << ", tightness " << tightness);
                        const auto limit = taut::max_step(stability, method, tightness);
                        check_numbers(limit);
                        if (!stable_everywhere(method))
                            CHECK((limit.certified == 0 ||
                                   excess(limit.certified) <= 4 * (1 + 1e-12L)));
                    }
                    const auto any = taut::any_pose_limit(system, tightness);
                    check_numbers(any);
                    CHECK((any.certified == 0 || excess(any.certified) <= 4 * (1 + 1e-12L)));
                }
                for (const double h : {1e-200, 1e-3, 1e100}) {
                    if (taut::certify(stability, Method::symplectic_euler, h).proved)
                        CHECK(excess(h) <= 4 * (1 + 1e-12L));
                }
            }
        }
    }
}

TEST_CASE("extremes: bare matrices near the ends of double", "[extremes]") {
    for (const double k : {1e-151, 1e-150, 1.0, 1e150, 1e151}) {
        for (const double m : {1e-151, 1e-150, 1.0, 1e150, 1e151}) {
            Eigen::Matrix2d K;
            K << 2 * k, -k, -k, 2 * k;
            const Eigen::Vector2d mass(m, m);
            const taut::LinearSystem<double> system(mass, {}, sparse(K));
            INFO("k = " << k << ", m = " << m);
            if (!in_range(k) || !in_range(m)) {
                CHECK_THROWS_WITH(
                    Stability<double>(system),
                    ContainsSubstring(in_range(k) ? "mass in row 0" : "stiffness in row 0"));
                continue;
            }
            const Stability<double> stability(system);
            for (const double tightness : {0.0, 1e-6}) {
                for (const Method method : limited_methods) {
                    const auto limit = taut::max_step(stability, method, tightness);
                    check_numbers(limit);
                    if (stable_everywhere(method)) continue;
                    const Real h = static_cast<Real>(limit.certified);
                    CHECK((h == 0 || h * h * 3 * static_cast<Real>(k) / static_cast<Real>(m) <=
                                         4 * (1 + 1e-12L)));
                }
            }
        }
    }
}

TEST_CASE("extremes: one particle, one spring, exact to the last digit but a few", "[extremes]") {
    Random random(1510);
    for (int repeat = 0; repeat < 300; ++repeat) {
        const double k = log_uniform(random, 1e-12, 1e15);
        const double m = log_uniform(random, 1e-9, 1e9);
        taut::SpringSystem<double, 1> system;
        system.add_particle(Eigen::Matrix<double, 1, 1>(0.0), 1);
        system.add_particle(Eigen::Matrix<double, 1, 1>(1.0), m);
        system.add_spring(0, 1, k);
        system.pin(0);
        const auto limit =
            Stability<double>(system, system.initial_state()).max_step(Method::symplectic_euler);
        const Real truth = 2 / std::sqrt(static_cast<Real>(k) / static_cast<Real>(m));
        CHECK(static_cast<Real>(limit.certified) <= truth);
        CHECK(static_cast<Real>(limit.refuted) >= truth);
        CHECK(limit.refuted <= limit.certified * (1 + 1e-12));
    }
}

TEST_CASE("extremes: lengths whose square overflows are refused by name", "[extremes]") {
    for (const double far : {1e149, 1e151, 1e306}) {
        for (const double rest : {1.0, 1e151}) {
            taut::SpringSystem<double, 3> system;
            system.add_particle({0, 0, 0}, 1);
            system.add_particle({-far, 4, 7}, 1e-3);
            system.add_spring(taut::Spring<double, taut::Hookean>{0, 1, {1e10}, rest});
            const auto state = system.initial_state();
            if (far > 1e150 || rest > 1e150) {
                CHECK_THROWS_WITH(Stability<double>(system, state),
                                  ContainsSubstring(far > 1e150 ? "position of particle 1"
                                                                : "rest length of spring 0"));
                continue;
            }
            const auto limit = Stability<double>(system, state).max_step(Method::symplectic_euler);
            check_numbers(limit);
            CHECK(limit.certified > 0);
            CHECK(limit.certified <= taut::any_pose_limit(system).refuted);
        }
    }
}

}  // namespace taut_test::extreme_analysis_test
