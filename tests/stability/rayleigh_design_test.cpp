// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/stability/rayleigh_design.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/methods.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::rayleigh_design_test {

using taut::EmptyWindow;
using taut::Method;
using taut::rayleigh_design;
using taut::rayleigh_from_ratios;

namespace {

/// The largest |μ| over a spectrum, its inside looked at as well.
double radius(Method method, double h, double d0, double alpha, double k_min, double k_max) {
    double largest = 0;
    for (const double part : {0.0, 0.01, 0.1, 0.4, 0.7, 1.0}) {
        const double k = k_min + part * (k_max - k_min);
        largest = std::max(largest, taut::spectral_radius(method, k, d0 + alpha * k, h));
    }
    return largest;
}

}  // namespace

TEST_CASE("rayleigh_design: both choices are inside the window, and the second settles fastest",
          "[stability][slow]") {
    Random random(1100);
    int designs = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
        const double k_max = log_uniform(random, 1e-3, 1e6);
        const double k_min = k_max * log_uniform(random, 1e-4, 1);
        const double h = 2 / std::sqrt(k_max) * log_uniform(random, 1e-2, 1);
        const double d0 = repeat % 3 == 0 ? 0 : 2 / h * log_uniform(random, 1e-3, 1);
        for (const Method method : limited_methods) {
            const auto design = rayleigh_design(method, h, d0, k_min, k_max);
            INFO(taut::name(method)
                 << ", h = " << h << ", d0 = " << d0 << ", k in [" << k_min << ", " << k_max
                 << "]: " << design.least_damping << ", " << design.fastest_settling);
            const auto window = taut::rayleigh_window(method, h, d0, k_min, k_max);
            CHECK(design.window.lower == window.lower);
            CHECK(design.window.upper == window.upper);
            CHECK(design.window.empty == window.empty);
            if (window.empty != EmptyWindow::none) continue;
            if (window.upper - window.lower < 1e-6 * window.upper) continue;
            ++designs;
            CHECK(window.contains(design.least_damping));
            // At its end the interval is closed where α = 0 belongs to it.
            CHECK(design.fastest_settling >= window.lower);
            CHECK(design.fastest_settling < window.upper);
            if (window.includes_zero) CHECK(design.least_damping == 0);

            // Brute force, on a scale that is linear near the ends and logarithmic beyond.
            const double best = radius(method, h, d0, design.fastest_settling, k_min, k_max);
            const double top = std::isfinite(window.upper) ? window.upper : 100 / std::sqrt(k_min);
            double scanned = radius(method, h, d0, design.least_damping, k_min, k_max);
            for (int i = 1; i < 2000; ++i) {
                const double part = i / 2000.0;
                scanned = std::min(scanned,
                                   radius(method, h, d0, window.lower + part * (top - window.lower),
                                          k_min, k_max));
                const double small = std::exp2(-20 * part) * (top - window.lower);
                scanned =
                    std::min(scanned, radius(method, h, d0, window.lower + small, k_min, k_max));
            }
            CHECK(best <= scanned + 1e-7);
            CHECK(best <= 1 + 1e-9);
        }
    }
    CHECK(designs > 800);
}

TEST_CASE("rayleigh_design: critical damping of a single frequency by hand", "[stability]") {
    // Continuous critical damping of ω = 10 is α = 2/ω; for a small step that settles fastest.
    const auto design = rayleigh_design(Method::symplectic_euler, 1e-5, 0, 100, 100);
    CHECK_THAT(design.fastest_settling, WithinRel(0.2, 1e-3));
    CHECK(design.least_damping == 0);
    // An empty window has no design.
    CHECK(rayleigh_design(Method::explicit_euler, 1, 0, 1, 100).window.empty ==
          EmptyWindow::step_too_large);
}

TEST_CASE("rayleigh_design: ratios to factors and back", "[stability]") {
    constexpr double rounding = Tolerance<double>::rounding;
    Random random(1101);
    int made = 0;
    for (int repeat = 0; repeat < 2000; ++repeat) {
        const double omega_1 = log_uniform(random, 1e-2, 1e4);
        const double omega_2 = omega_1 * log_uniform(random, 1.01, 1e3);
        const double zeta_1 = log_uniform(random, 1e-4, 2);
        const double zeta_2 = zeta_1 * log_uniform(random, 0.1, 10);
        // Between them: ζ2/ζ1 from ω1/ω2 (mass alone) to ω2/ω1 (stiffness alone).
        const double ratio = zeta_2 / zeta_1;
        const double spread = omega_2 / omega_1;
        const bool possible = ratio < spread * (1 - 1e-9) && ratio > (1 + 1e-9) / spread;
        const bool impossible = ratio > spread * (1 + 1e-9) || ratio < (1 - 1e-9) / spread;
        INFO(omega_1 << ", " << zeta_1 << ", " << omega_2 << ", " << zeta_2);
        if (impossible) {
            CHECK_THROWS_AS(rayleigh_from_ratios(omega_1, zeta_1, omega_2, zeta_2),
                            std::invalid_argument);
        } else if (possible) {
            const auto rayleigh = rayleigh_from_ratios(omega_1, zeta_1, omega_2, zeta_2);
            CHECK(rayleigh.mass_proportional >= 0);
            CHECK(rayleigh.stiffness_proportional >= 0);
            // Close frequencies magnify rounding.
            const double worse = rounding * spread / (spread - 1);
            CHECK_THAT(damping_ratio(rayleigh, omega_1), WithinRel(zeta_1, worse));
            CHECK_THAT(damping_ratio(rayleigh, omega_2), WithinRel(zeta_2, worse));
            // The order of the two does not matter.
            const auto swapped = rayleigh_from_ratios(omega_2, zeta_2, omega_1, zeta_1);
            CHECK_THAT(damping_ratio(swapped, omega_1), WithinRel(zeta_1, worse));
            ++made;
        }
    }
    CHECK(made > 1000);
    // Each factor alone: ζ falls like 1/ω by d0, grows like ω by α.
    const auto mass = rayleigh_from_ratios(1, 0.5, 2, 0.25);
    CHECK_THAT(mass.mass_proportional, WithinRel(1.0, rounding));
    CHECK(mass.stiffness_proportional == 0);
    const auto stiffness = rayleigh_from_ratios(1, 0.5, 2, 1);
    CHECK_THAT(stiffness.stiffness_proportional, WithinRel(1.0, rounding));
    CHECK(stiffness.mass_proportional == 0);
    const auto none = rayleigh_from_ratios(1, 0, 2, 0);
    CHECK(none.mass_proportional == 0);
    CHECK(none.stiffness_proportional == 0);
}

TEST_CASE("rayleigh_design: wrong input is refused by name", "[stability]") {
    const double nan = std::nan("");
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, infinite}) {
        CHECK(missing(message_of([&] {
                          taut::damping_ratio({1, 1}, bad);
                      }),
                      {"damping_ratio", "omega"}) == "");
        CHECK(missing(message_of([&] { rayleigh_from_ratios(bad, 0.1, 2, 0.1); }),
                      {"rayleigh_from_ratios", "frequencies"}) == "");
        CHECK(missing(message_of([&] { rayleigh_from_ratios(2, 0.1, bad, 0.1); }),
                      {"rayleigh_from_ratios", "frequencies"}) == "");
    }
    CHECK(missing(message_of([] { rayleigh_from_ratios(2, 0.1, 2, 0.1); }), {"different"}) == "");
    for (const double bad : {-0.1, nan, infinite}) {
        CHECK(missing(message_of([&] { rayleigh_from_ratios(1, bad, 2, 0.1); }), {"zeta_1"}) == "");
        CHECK(missing(message_of([&] { rayleigh_from_ratios(1, 0.1, 2, bad); }), {"zeta_2"}) == "");
    }
    CHECK(missing(message_of([] { rayleigh_from_ratios(1, 1, 2, 100); }), {"d0", "alpha", "100"}) ==
          "");
}

}  // namespace taut_test::rayleigh_design_test
