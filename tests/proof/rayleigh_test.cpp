// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/proof/rayleigh.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/proof_scenes.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::rayleigh_test {

using taut::EmptyWindow;
using taut::Method;
using taut::rayleigh_window;

namespace {

constexpr Method explicit_methods[] = {Method::explicit_euler, Method::symplectic_euler,
                                       Method::velocity_verlet};
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Whether one mode is stable, by the 2 × 2 matrix's characteristic polynomial and Jury's
/// conditions in long double; by a negative amount if not. A zero mode needs |1 − hd| ≤ 1 alone.
Real margin(Method method, double step, double mass_proportional, double alpha, double stiffness) {
    const Real h = step, k = stiffness;
    const Real d = static_cast<Real>(mass_proportional) + static_cast<Real>(alpha) * k;
    if (k == 0 && d == 0) return 1;
    const bool is_explicit = method == Method::explicit_euler;
    const Real trace = is_explicit ? 2 - h * d : 2 - h * d - h * h * k;
    const Real determinant = is_explicit ? 1 - h * d + h * h * k : 1 - h * d;
    const Real above = 1 + determinant + trace;  // μ = −1 is outside
    const Real within =
        d == 0 && !is_explicit ? Real(1) : 1 - determinant;  // neutral when undamped
    return std::min(above, within);
}

/// Over the whole spectrum; linear in k, yet looked at in between too.
Real margin(Method method, double h, double d0, double alpha, double k_min, double k_max) {
    Real least = 1e30L;
    for (const double part : {0.0, 1e-3, 0.1, 0.4, 0.8, 1.0}) {
        const double k = part == 1 ? k_max : k_min + part * (k_max - k_min);
        least = std::min(least, margin(method, h, d0, alpha, k));
    }
    return least;
}

struct Problem {
    double h, d0, k_min, k_max;
};

/// Steps around 2/√k_max, dampings around 2/h, k_min anywhere, 0 and k_max included.
template <class Visit>
void for_each_problem(std::uint32_t seed, int count, Visit&& visit) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        Problem p{};
        p.k_max = log_uniform(random, 1e-3, 1e6);
        const Index kind = random.below(6);
        p.k_min = kind == 0   ? 0
                  : kind == 1 ? p.k_max
                  : kind == 2 ? p.k_max * random.uniform(0.5, 1)
                              : p.k_max * log_uniform(random, 1e-6, 1);
        p.h = 2 / std::sqrt(p.k_max) * log_uniform(random, 1e-2, 1.5);
        p.d0 = random.below(3) == 0 ? 0 : 2 / p.h * log_uniform(random, 1e-2, 2);
        // Beyond 2/h only a k_min well above zero leaves a window [T15].
        if (kind == 2 || kind == 3) {
            p.d0 = 2 / p.h * (1 + p.h * p.h * p.k_min / 4 * random.uniform(0, 1.2));
        }
        visit(p);
    }
}

}  // namespace

TEST_CASE("rayleigh: every edge of the window, from both sides", "[proof]") {
    int lower = 0, upper_at_max = 0, upper_at_min = 0, clipped = 0, symplectic = 0;
    for_each_problem(600, 3000, [&](const Problem& p) {
        for (const Method method : explicit_methods) {
            const auto window = rayleigh_window(method, p.h, p.d0, p.k_min, p.k_max);
            if (window.empty != EmptyWindow::none) continue;
            INFO(taut::name(method)
                 << ", h = " << p.h << ", d0 = " << p.d0 << ", k in [" << p.k_min << ", " << p.k_max
                 << "]: " << window.lower << ", " << window.upper);
            const auto stable = [&](double alpha) {
                return margin(method, p.h, p.d0, alpha, p.k_min, p.k_max) > 0;
            };
            const double width = window.upper - window.lower;
            REQUIRE(width > 0);
            REQUIRE(window.lower >= 0);
            if (width < 1e-6 * window.upper) continue;  // its own ends are no better known
            for (const double part : {1e-6, 0.1, 0.5, 0.9, 1 - 1e-6}) {
                const double alpha = window.lower + part * width;
                CHECK(window.contains(alpha));
                CHECK(stable(alpha));
            }
            for (const double part : {1 + 1e-6, 1.1, 3.0}) {
                CHECK_FALSE(window.contains(window.lower + part * width));
                CHECK_FALSE(stable(window.lower + part * width));
            }
            CHECK(window.contains(0) == (window.includes_zero || window.lower < 0));
            if (window.lower > 0) {
                for (const double part : {1 - 1e-6, 0.5, 0.0}) {
                    CHECK_FALSE(window.contains(part * window.lower));
                    CHECK_FALSE(stable(part * window.lower));
                }
                CHECK_FALSE(window.includes_zero);
                ++lower;
            } else {
                ++clipped;
                if (window.includes_zero) CHECK(stable(0));
            }
            CHECK_FALSE(window.contains(-1e-3 * window.upper));
            CHECK_FALSE(window.contains(std::nan("")));
            if (method != Method::explicit_euler) {
                ++symplectic;
            } else {
                // Which end of the spectrum is it that fails first?
                const double out = window.lower + (1 + 1e-6) * width;
                ++(margin(method, p.h, p.d0, out, p.k_max) < 0 ? upper_at_max : upper_at_min);
            }
        }
    });
    // Every edge has been met.
    CHECK(lower > 100);
    CHECK(clipped > 100);
    CHECK(upper_at_max > 100);
    CHECK(upper_at_min > 100);
    CHECK(symplectic > 100);
}

TEST_CASE("rayleigh: an empty window has no stable alpha, and its reason is the true one",
          "[proof]") {
    int step = 0, mass = 0;
    for_each_problem(601, 2000, [&](const Problem& p) {
        for (const Method method : explicit_methods) {
            const auto window = rayleigh_window(method, p.h, p.d0, p.k_min, p.k_max);
            if (window.empty == EmptyWindow::none) continue;
            INFO(taut::name(method) << ", h = " << p.h << ", d0 = " << p.d0 << ", k in [" << p.k_min
                                    << ", " << p.k_max << "]");
            CHECK_FALSE(window.contains(0));
            CHECK_FALSE(window.contains(p.h));
            CHECK_FALSE(window.includes_zero);
            for (int i = 0; i <= 200; ++i) {
                const double alpha = i == 0 ? 0 : p.h * std::exp2((i - 150) / 10.0);
                CHECK_FALSE(margin(method, p.h, p.d0, alpha, p.k_min, p.k_max) > 1e-12L);
            }
            // A smaller step, or less of d0, is the cure that the reason names.
            if (window.empty == EmptyWindow::step_too_large) {
                ++step;
                CHECK(rayleigh_window(method, p.h, 0, p.k_min, p.k_max).empty ==
                      EmptyWindow::step_too_large);
                CHECK(
                    rayleigh_window(method, 1.9 / std::sqrt(p.k_max), 0, p.k_min, p.k_max).empty ==
                    EmptyWindow::none);
            } else {
                ++mass;
                CHECK(p.d0 > 0);
                CHECK(rayleigh_window(method, p.h, 0, p.k_min, p.k_max).empty == EmptyWindow::none);
            }
        }
    });
    CHECK(step > 100);
    CHECK(mass > 100);
    CHECK(std::string(describe(EmptyWindow::none)) != describe(EmptyWindow::step_too_large));
    CHECK(std::string(describe(EmptyWindow::mass_damping_too_large)).size() > 10);
    CHECK(std::string(describe(EmptyWindow::overflow)).size() > 10);
}

TEST_CASE("rayleigh: zero modes, the very edge, and the implicit method", "[proof]") {
    // At d0 = h k_max the stiffest mode has |μ| = 1 without α.
    CHECK_FALSE(rayleigh_window(Method::explicit_euler, 0.5, 2, 1, 4).includes_zero);
    CHECK(rayleigh_window(Method::explicit_euler, 0.5, 2.5, 1, 4).includes_zero);
    // k_min = 0: nothing but h·d0 < 2 from the zero mode.
    for (const Method method : explicit_methods) {
        CHECK(rayleigh_window(method, 0.1, 19.9, 0, 1).empty == EmptyWindow::none);
        CHECK(rayleigh_window(method, 0.1, 20.1, 0, 1).empty ==
              EmptyWindow::mass_damping_too_large);
        CHECK(std::isfinite(rayleigh_window(method, 0.1, 0, 0, 1).upper));
        // k_max = 0: any α.
        const auto any = rayleigh_window(method, 0.1, 1, 0, 0);
        CHECK(any.empty == EmptyWindow::none);
        CHECK(any.upper == infinity);
        CHECK(any.contains(0));
        CHECK(any.contains(1e300));
        CHECK(rayleigh_window(method, 0.1, 30, 0, 0).empty == EmptyWindow::mass_damping_too_large);
    }
    for (const double h : {1e-6, 1.0, 1e6}) {
        for (const double d0 : {0.0, 1e6}) {
            const auto window = rayleigh_window(Method::implicit_euler, h, d0, 0, 1e9);
            CHECK(window.empty == EmptyWindow::none);
            CHECK(window.contains(0));
            CHECK(window.contains(1e9));
            CHECK(window.upper == infinity);
        }
    }
}

TEST_CASE("rayleigh: with compression no alpha in the window lets the step add growth",
          "[proof][slow]") {
    Random random(602);
    int windows = 0;
    int buckled = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
        const Index n = 2 + random.below(4);
        Eigen::VectorXd k(n), drop(n);
        for (Index i = 0; i < n; ++i) {
            k[i] = random.below(4) == 0 ? 0 : log_uniform(random, 1e-3, 1);
            drop[i] = random.below(2) == 0 ? 0 : log_uniform(random, 1e-2, 3);
        }
        k[0] = 1;
        Exact e;
        e.mass = RealVector::Ones(n);
        e.K_plus = with_spectrum(random, k).cast<Real>();
        const Eigen::MatrixXd lost = with_spectrum(random, drop);
        e.K = e.K_plus - lost.cast<Real>();
        const double h = log_uniform(random, 0.01, 2);
        const double d0 = random.below(3) == 0 ? 0 : log_uniform(random, 0.01, 2) / h;
        // Room for the rounding of the two matrices.
        const double k_min = std::max(0.0, k.minCoeff() - 1e-12);
        const double compression = drop.maxCoeff() * (1 + 1e-12) + 1e-12;
        const auto window =
            rayleigh_window(Method::explicit_euler, h, d0, k_min, 1 + 1e-12, compression);
        if (window.empty != EmptyWindow::none) continue;
        ++windows;
        for (const double part : {1e-6, 0.5, 1 - 1e-6}) {
            const double alpha = window.lower + part * (window.upper - window.lower);
            e.D = static_cast<Real>(alpha) * e.K_plus;
            e.D.diagonal().array() += static_cast<Real>(d0);
            const Multipliers multipliers(e);
            buckled += multipliers.buckled() ? 1 : 0;
            INFO("system " << repeat << ", h = " << h << ", d0 = " << d0 << ", alpha = " << alpha);
            CHECK(multipliers.induced_radius(Method::explicit_euler, h) <= 1 + 1e-9L);
        }
    }
    CHECK(windows > 100);
    CHECK(buckled > 100);
}

TEST_CASE("rayleigh: compression only narrows the window of explicit Euler", "[proof]") {
    // The true K = −1 under K⁺ = 0 with d = 1.9 at h = 1 has the multiplier −1.33.
    CHECK(rayleigh_window(Method::explicit_euler, 1, 1.9, 0, 0).empty == EmptyWindow::none);
    CHECK(rayleigh_window(Method::explicit_euler, 1, 1.9, 0, 0, 1).empty ==
          EmptyWindow::mass_damping_too_large);
    CHECK(rayleigh_window(Method::explicit_euler, 2, 0, 0, 0, 1.01).empty ==
          EmptyWindow::step_too_large);
    for_each_problem(603, 1000, [](const Problem& p) {
        for (const Method method : explicit_methods) {
            const auto without = rayleigh_window(method, p.h, p.d0, p.k_min, p.k_max);
            const auto with = rayleigh_window(method, p.h, p.d0, p.k_min, p.k_max, p.k_max / 4);
            if (with.empty != EmptyWindow::none) continue;
            REQUIRE(without.empty == EmptyWindow::none);
            CHECK(with.lower == without.lower);
            CHECK(with.upper <= without.upper);
            if (method != Method::explicit_euler) CHECK(with.upper == without.upper);
        }
    });
}

TEST_CASE("rayleigh: whatever a window contains is stable, to the last bit of its ends",
          "[proof]") {
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    // The conditions are sums of terms of this size, here taken in long double.
    constexpr Real noise = 16 * real_epsilon;
    Random random(604);
    int windows = 0;
    for (int repeat = 0; repeat < 10000; ++repeat) {
        Problem p{};
        p.k_max = log_uniform(random, 1e-3, 1e6);
        const Index kind = random.below(4);
        p.k_min = kind == 0 ? 0 : kind == 1 ? p.k_max : p.k_max * log_uniform(random, 1e-9, 1);
        // A few ulp off h·d0 = 2, off h²k = 4, or off neither.
        const double off = 1 - static_cast<double>(random.below(200) - 100) * ulp;
        const bool long_step = repeat % 3 == 0;
        p.h = 2 / std::sqrt(p.k_max) * (long_step ? off : log_uniform(random, 1e-4, 1));
        p.d0 = long_step         ? random.uniform(0, 1) / p.h
               : repeat % 3 == 1 ? 2 / p.h * off
                                 : random.uniform(0, 2) / p.h;
        for (const Method method : explicit_methods) {
            const auto window = rayleigh_window(method, p.h, p.d0, p.k_min, p.k_max);
            if (window.empty != EmptyWindow::none) continue;
            ++windows;
            for (const double alpha :
                 {0.0, std::nextafter(window.lower, infinity), std::nextafter(window.upper, 0.0),
                  window.lower / 2 + window.upper / 2}) {
                if (!window.contains(alpha)) continue;
                INFO(taut::name(method) << ", h = " << p.h << ", d0 = " << p.d0 << ", k in ["
                                        << p.k_min << ", " << p.k_max << "], alpha = " << alpha);
                CHECK(margin(method, p.h, p.d0, alpha, p.k_min, p.k_max) >= -noise);
            }
        }
    }
    CHECK(windows > 10000);
}

TEST_CASE("rayleigh: wrong input is refused", "[proof]") {
    const auto window = [](double h, double d0, double k_min, double k_max) {
        return rayleigh_window(Method::explicit_euler, h, d0, k_min, k_max);
    };
    const double nan = std::nan("");
    for (const double bad : {0.0, -1.0, nan, infinity}) {
        CHECK_THROWS_AS(window(bad, 0, 0, 1), std::invalid_argument);
    }
    for (const double bad : {-1.0, nan, infinity}) {
        CHECK_THROWS_AS(window(0.1, bad, 0, 1), std::invalid_argument);
        CHECK_THROWS_AS(window(0.1, 0, bad, 1), std::invalid_argument);
        CHECK_THROWS_AS(window(0.1, 0, 0, bad), std::invalid_argument);
    }
    CHECK_THROWS_AS(window(0.1, 0, 2, 1), std::invalid_argument);
}

TEST_CASE("rayleigh: the damping ratio falls like 1/omega by d0 and grows like omega by alpha",
          "[proof]") {
    constexpr double rounding = Tolerance<double>::rounding;
    Random random(1101);
    for (int repeat = 0; repeat < 500; ++repeat) {
        const double omega = log_uniform(random, 1e-2, 1e4);
        const double zeta = log_uniform(random, 1e-4, 2);
        const double spread = log_uniform(random, 1.01, 1e3);
        const taut::RayleighDamping by_mass{2 * zeta * omega, 0};
        const taut::RayleighDamping by_stiffness{0, 2 * zeta / omega};
        CHECK_THAT(damping_ratio(by_mass, omega), WithinRel(zeta, rounding));
        CHECK_THAT(damping_ratio(by_mass, spread * omega), WithinRel(zeta / spread, rounding));
        CHECK_THAT(damping_ratio(by_stiffness, omega), WithinRel(zeta, rounding));
        CHECK_THAT(damping_ratio(by_stiffness, spread * omega), WithinRel(zeta * spread, rounding));
        // The mode's own ratio: d/(2ω) of ẍ + dẋ + ω²x with d = d0 + αω².
        const taut::RayleighDamping both{by_mass.mass_proportional,
                                         by_stiffness.stiffness_proportional};
        CHECK_THAT(damping_ratio(both, omega), WithinRel(2 * zeta, rounding));
    }
    for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK(missing(message_of([&] {
                          (void)taut::damping_ratio({1, 1}, bad);
                      }),
                      {"damping_ratio", "omega"}) == "");
    }
}

}  // namespace taut_test::rayleigh_test
