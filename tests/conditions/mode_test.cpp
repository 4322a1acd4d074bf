// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <set>
#include <string>
#include <taut/conditions/mode.hpp>

#include "../support/catch.hpp"
#include "../support/methods.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::mode_test {

using taut::critical_step;
using taut::Method;

namespace {

using Real = long double;
using Complex = std::complex<Real>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The 2 × 2 matrix of one step on (x, v), from [T4]–[T6].
struct Step {
    Real xx, xv, vx, vv;

    Real trace() const { return xx + vv; }
    Real determinant() const { return xx * vv - xv * vx; }
    /// The eigenvalues, the one of larger modulus first.
    std::array<Complex, 2> eigenvalues() const {
        const Real half = trace() / 2;
        const Real under = half * half - determinant();
        if (under < 0) return {Complex(half, std::sqrt(-under)), Complex(half, -std::sqrt(-under))};
        const Real large = half + std::copysign(std::sqrt(under), half);
        return {large, large == 0 ? 0 : determinant() / large};
    }
    Real radius() const {
        const auto mu = eigenvalues();
        return std::max(std::abs(mu[0]), std::abs(mu[1]));
    }
};

Step transition(Method method, double stiffness, double damping, double seconds) {
    const Real k = stiffness, d = damping, h = seconds;
    switch (method) {
        case Method::explicit_euler: return {1, h, -h * k, 1 - h * d};
        case Method::symplectic_euler:
        case Method::velocity_verlet: return {1 - h * h * k, h * (1 - h * d), -h * k, 1 - h * d};
        case Method::implicit_euler: {
            const Real a = 1 + h * d + h * h * k;  // determinant of I − hC
            return {(1 + h * d) / a, h / a, -h * k / a, 1 / a};
        }
        case Method::bdf2:                        // 4 × 4
        case Method::energy_stable_euler: break;  // descriptor_test.cpp
    }
    FAIL("no transition matrix of " << name(method));
    return {};
}

/// visit(k, d): undamped, light, critical, overdamped; stiffness alone, damping alone.
template <class Visit>
void for_each_mode(std::uint32_t seed, Visit&& visit) {
    Random random(seed);
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const double k = log_uniform(random, 1e-6, 1e9);
        const double omega = std::sqrt(k);
        visit(k, 0.0);
        visit(k, 2 * omega * log_uniform(random, 1e-4, 1));
        visit(k, 2 * omega * log_uniform(random, 1, 1e4));
        visit(k, 2 * omega * (1 + random.uniform(-1e-3, 1e-3)));
        visit(0.0, omega);
    }
}

}  // namespace

TEST_CASE("mode: step_quadratic and multipliers are those of the transition matrix",
          "[conditions]") {
    constexpr double rounding = Tolerance<double>::rounding;
    Random random(501);
    for_each_mode(500, [&](double k, double d) {
        const double h = log_uniform(random, 1e-4, 1e2) / (std::sqrt(k) + d);
        for (const Method method : limited_methods) {
            INFO(taut::name(method) << ", k = " << k << ", d = " << d << ", h = " << h);
            const Step step = transition(method, k, d, h);
            const double size = 2 + h * d + h * h * k;
            const auto quadratic = taut::step_quadratic(method, k, d, h);
            CHECK_THAT(quadratic.b, WithinAbs(static_cast<double>(-step.trace()), rounding * size));
            CHECK_THAT(quadratic.c,
                       WithinAbs(static_cast<double>(step.determinant()), rounding * size));
            const auto mu = taut::multipliers(method, k, d, h);
            const auto exact = step.eigenvalues();
            const auto half = static_cast<double>(step.trace() / 2);
            const double under =
                static_cast<double>(step.trace() * step.trace() / 4 - step.determinant());
            // Where two roots meet, a root moves by the square root of a rounding.
            const double error = rounding * size * size /
                                 std::max(std::sqrt(std::abs(under)), std::sqrt(rounding) * size);
            for (const auto& root : exact) {
                const std::complex<double> expected(static_cast<double>(root.real()),
                                                    static_cast<double>(root.imag()));
                CHECK(std::min(std::abs(mu[0] - expected), std::abs(mu[1] - expected)) <=
                      error + rounding * std::abs(half));
            }
            CHECK_THAT(taut::spectral_radius(method, k, d, h),
                       WithinAbs(static_cast<double>(step.radius()), error + rounding * size));
        }
    });
}

TEST_CASE("mode: the smaller root loses nothing to cancellation", "[conditions]") {
    Random random(502);
    for (int repeat = 0; repeat < 3000; ++repeat) {
        const double k = log_uniform(random, 1e-3, 1e3);
        const double d = std::sqrt(k) * log_uniform(random, 10, 1e8);
        const double h = log_uniform(random, 1e-3, 1e3) / d;
        for (const Method method : limited_methods) {
            INFO(taut::name(method) << ", k = " << k << ", d = " << d << ", h = " << h);
            const auto [b, c] = taut::step_quadratic(method, k, d, h);
            const Real half = -static_cast<Real>(b) / 2;
            const Real under = half * half - static_cast<Real>(c);
            if (under < 1e-3L * half * half) continue;
            const Real large = half + std::copysign(std::sqrt(under), half);
            const auto mu = taut::multipliers(method, k, d, h);
            CHECK(mu[0].imag() == 0);
            CHECK_THAT(mu[0].real(), WithinRel(static_cast<double>(large), 1e-12));
            CHECK_THAT(mu[1].real(), WithinRel(static_cast<double>(c / large), 1e-12));
            CHECK(std::abs(mu[0]) >= std::abs(mu[1]) * (1 - 1e-12));
        }
    }
}

TEST_CASE("mode: stable just below critical_step, unstable just above", "[conditions]") {
    for_each_mode(503, [&](double k, double d) {
        for (const Method method : limited_methods) {
            const double h = critical_step(method, k, d);
            INFO(taut::name(method) << ", k = " << k << ", d = " << d << ", h = " << h);
            if (method == Method::explicit_euler && d == 0) {
                CHECK(h == 0);  // every step grows
                CHECK(transition(method, k, d, 1e-3 / std::sqrt(k)).radius() > 1);
                continue;
            }
            if (method == Method::implicit_euler) {
                CHECK(h == infinity);
                for (const double z : {1e-3, 1.0, 1e3}) {
                    const Real radius = transition(method, k, d, z / (std::sqrt(k) + d)).radius();
                    CHECK(radius <= 1 + 1e-17L);
                    // Apart from the zero mode's 1 all is damped, without physical damping too.
                    if (k > 0) CHECK(radius < 1);
                }
                continue;
            }
            REQUIRE(h > 0);
            REQUIRE(std::isfinite(h));
            for (const double part : {1 - 1e-9, 0.999, 0.5, 0.01}) {
                const Real radius = transition(method, k, d, part * h).radius();
                CHECK(radius <= 1 + 1e-17L);
                if (d > 0 && k > 0) CHECK(radius < 1);
            }
            for (const double part : {1 + 1e-9, 1.001, 2.0, 100.0}) {
                CHECK(transition(method, k, d, part * h).radius() > 1);
            }
            CHECK_THAT(static_cast<double>(transition(method, k, d, h).radius()),
                       WithinAbs(1.0, 1e-6));
        }
    });
}

TEST_CASE("mode: closed forms by hand", "[conditions]") {
    constexpr double rounding = Tolerance<double>::rounding;
    // k = 100: undamped 2/√k; d = 15 < 2ω: d/k; d = 25 > 2ω: 4/(25 + 15); zero stiffness 2/d.
    CHECK_THAT(critical_step(Method::symplectic_euler, 100, 0), WithinRel(0.2, rounding));
    CHECK_THAT(critical_step(Method::symplectic_euler, 100, 15), WithinRel(0.1, rounding));
    CHECK_THAT(critical_step(Method::explicit_euler, 100, 15), WithinRel(0.15, rounding));
    CHECK_THAT(critical_step(Method::explicit_euler, 100, 25), WithinRel(0.1, rounding));
    CHECK_THAT(critical_step(Method::explicit_euler, 100, 20), WithinRel(0.2, rounding));
    CHECK_THAT(critical_step(Method::explicit_euler, 0, 4), WithinRel(0.5, rounding));
    CHECK_THAT(critical_step(Method::symplectic_euler, 0, 4), WithinRel(0.5, rounding));
    for (const Method method : limited_methods) CHECK(critical_step(method, 0, 0) == infinity);
    // κ = 4: implicit Euler turns singular at 1/√κ.
    CHECK_THAT(critical_step(Method::implicit_euler, -4, 0), WithinRel(0.5, rounding));
    CHECK(critical_step(Method::symplectic_euler, -4, 3) == infinity);
}

TEST_CASE("mode: no square vanishes or overflows on the way to critical_step", "[conditions]") {
    Random random(506);
    for (int repeat = 0; repeat < 3000; ++repeat) {
        const double k = repeat % 4 == 0 ? 0 : log_uniform(random, 1e-307, 1e307);
        const double d = repeat % 4 == 1 ? 0 : log_uniform(random, 1e-307, 1e307);
        INFO("k = " << k << ", d = " << d);
        const Real dd = d, kk = k;
        // The multipliers of a step of 1 s without stiffness are 1 and 1 − d. Where these are
        // nearly one, rounding moves them by its square root, but not (μ − 1)(μ − 1 + d).
        const auto mu = taut::multipliers(Method::symplectic_euler, 0, d, 1);
        const Real size = std::max(Real(1), dd);
        for (const auto& m : mu) {
            const std::complex<Real> beyond_1(Real(m.real()) - 1, m.imag());
            CHECK(std::abs(beyond_1 / size * ((beyond_1 + dd) / size)) <= 1e-14L);
        }
        const auto sum = std::complex<Real>(mu[0]) + std::complex<Real>(mu[1]);
        CHECK(std::abs(sum - (2 - dd)) <= 1e-14L * size);
        CHECK(taut::spectral_radius(Method::symplectic_euler, 0, d, 1) ==
              std::max(std::abs(mu[0]), std::abs(mu[1])));
        const auto check = [](double h, Real exact) {
            if (exact > static_cast<Real>(std::numeric_limits<double>::max())) {
                CHECK(h == infinity);
            } else if (exact > 1e-307L) {
                CHECK_THAT(h, WithinRel(static_cast<double>(exact), 1e-14));
            }
        };
        check(critical_step(Method::symplectic_euler, k, d),
              4 / (dd + std::sqrt(dd * dd + 4 * kk)));
        const Real under = dd * dd - 4 * kk;
        // Where two roots meet, the limit moves by the square root of a rounding.
        if (std::abs(under) > 1e-3L * dd * dd) {
            check(critical_step(Method::explicit_euler, k, d),
                  under < 0 ? dd / kk : 4 / (dd + std::sqrt(under)));
        }
        if (k == 0) continue;
        check(critical_step(Method::implicit_euler, -k, d),
              (dd + std::sqrt(dd * dd + 4 * kk)) / (2 * kk));
        // A buckled mode of symplectic Euler has a limit where it is overdamped.
        if (under > 1e-3L * dd * dd) {
            check(critical_step(Method::symplectic_euler, -k, d), 4 / (dd + std::sqrt(under)));
        } else if (under < -1e-3L * kk) {
            CHECK(critical_step(Method::symplectic_euler, -k, d) == infinity);
        }
    }
}

TEST_CASE("mode: a buckled mode is limited by the step alone", "[conditions]") {
    Random random(504);
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const double kappa = log_uniform(random, 1e-3, 1e3);
        const double d = repeat % 5 == 0 ? 0 : std::sqrt(kappa) * log_uniform(random, 1e-3, 1e3);
        for (const Method method : limited_methods) {
            const double h = critical_step(method, -kappa, d);
            INFO(taut::name(method) << ", k = " << -kappa << ", d = " << d << ", h = " << h);
            REQUIRE(h > 0);
            const auto least = [&](double step) {
                const auto mu = transition(method, -kappa, d, step).eigenvalues();
                CHECK(std::abs(mu[0].imag()) <= 1);
                Real value = infinity;
                for (const auto& root : mu) {
                    if (std::abs(root.imag()) < 1e-12L) value = std::min(value, root.real());
                }
                return value;
            };
            const double scale = 1 / (std::sqrt(kappa) + d);
            for (const double part : {1e-3, 0.5, 1 - 1e-9}) {
                const double below = std::isfinite(h) ? part * h : 10 * part * scale;
                CHECK(least(below) > -1);
            }
            if (!std::isfinite(h)) {
                CHECK(method != Method::explicit_euler);
                CHECK(method != Method::implicit_euler);
                for (const double z : {1.0, 100.0, 1e4}) CHECK(least(z * scale) > -1);
            } else if (method == Method::implicit_euler) {
                // The matrix of the step is singular there: a multiplier comes back from −∞.
                CHECK(least(h * (1 + 1e-9)) < -1e3L);
            } else {
                CHECK(least(h * (1 + 1e-9)) < -1);
            }
        }
    }
}

TEST_CASE("mode: velocity Verlet and buckled energy-stable modes are those of symplectic Euler",
          "[conditions]") {
    Random random(505);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const double k = random.uniform(-10, 100), d = random.uniform(0, 20);
        const double h = random.uniform(0.001, 1);
        CHECK(critical_step(Method::velocity_verlet, k, d) ==
              critical_step(Method::symplectic_euler, k, d));
        CHECK(taut::spectral_radius(Method::velocity_verlet, k, d, h) ==
              taut::spectral_radius(Method::symplectic_euler, k, d, h));
        CHECK((taut::multipliers(Method::velocity_verlet, k, d, h) ==
               taut::multipliers(Method::symplectic_euler, k, d, h)));
        // Energy-stable Euler damps by the stiffness of what is not buckled, h k.
        CHECK((taut::multipliers(Method::energy_stable_euler, k, d, h) ==
               taut::multipliers(Method::symplectic_euler, k, d + h * std::max(0.0, k), h)));
    }
}

}  // namespace taut_test::mode_test
