// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <taut/network/buckling.hpp>
#include <taut/step/spring_table.hpp>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::buckling_test {

namespace {

template <class Scalar>
using Parameters = Buckling::Parameters<Scalar>;

/// A spring whose line meets the beam never (c < 7.87), twice (c < π²) or once.
Parameters<double> with_onset(double c, double bending, double L) {
    return {100, bending, 4 * c * bending / (L * L * L)};
}

/// An onset that nothing reaches: the beam alone, but for its last 1e-9.
Parameters<double> beam_alone(double bending) { return {0, bending, 1e12 * bending}; }

}  // namespace

TEMPLATE_TEST_CASE("buckling: what bends an arc is w of [T30] in full precision", "[network]",
                   float, double, long double) {
    using Arc = taut::network_detail::Arc<TestType>;
    using Long = long double;
    const double epsilon = Tolerance<TestType>::epsilon;
    const auto off = [](TestType a, Long b) { return static_cast<double>(std::abs(a / b - 1)); };
    const Long touching = std::acos(-1.0L);
    for (int i = 1; i <= 1000; ++i) {
        const Long y = touching * i / 1000;  // half the arc's angle
        Long term = 1.0L / 6;                // (−1)^m w^m/(2m + 3)!
        Long sag = 0, lever = 0, lever_w = 0, before = 0;
        for (int m = 0; m < 24; ++m) {
            sag += term;
            lever += (2 * m + 2) * term;  // (sinc y − cos y)/w
            lever_w += m * (2 * m + 2) * before;
            before = -term / ((2 * m + 4) * (2 * m + 5));
            term = before * y * y;
        }
        const auto lambda = static_cast<TestType>(1 - y * y * sag);
        // G and its slope where λ is rounded.
        const Long rounded = lambda - (1 - y * y * sag);
        const Long curvature = -2 * lever_w / (lever * lever * lever);
        CHECK(off(Arc::slope(lambda), 1 / lever - curvature * rounded) <= 8 * epsilon);
        // Relative to the largest, which the law's bound is made of. At the ends of the interval
        // what ten poles leave out is 75 roundings of long double.
        const Long largest = 3 * touching * touching;
        CHECK(static_cast<double>(std::abs(Arc::curvature(lambda) - curvature) / largest) <=
              (std::numeric_limits<TestType>::digits > 53 ? 96 : 8) * epsilon);
        CHECK(off(Arc::work(0, 1 - lambda), y * y / 2 - rounded / lever) <=
              8 * epsilon / static_cast<double>(1 - lambda));
    }
}

#if !defined(__clang__) && !defined(__i386__)  // which contract or widen numbers, not registers
TEMPLATE_TEST_CASE("buckling: registers have the bits of numbers", "[network]", float, double) {
    using Register = taut::step_detail::VectorRegister<TestType>;
    Random random(6);
    for (int trial = 0; trial < 5000; ++trial) {
        const auto draw = [&](double most) {
            return static_cast<TestType>(random.uniform(0, most));
        };
        const Parameters<TestType> p{draw(100), trial % 7 == 0 ? 0 : draw(0.01), draw(1000)};
        const TestType L = trial % 11 == 0 ? 0 : draw(1) + TestType(0.1);
        TestType lengths[Register::width + 4], results[3][Register::width];
        for (TestType& l : lengths) l = draw(2);
        lengths[0] = L;
        lengths[1] = std::nextafter(L, TestType(0));
        lengths[2] = std::numeric_limits<TestType>::quiet_NaN();
        lengths[3] = std::numeric_limits<TestType>::infinity();
        const auto l = Register::load(lengths + trial % 5);
        const auto q = p.template cast<Register>();
        Buckling::tension(q, Register(L), l).store(results[0]);
        Buckling::tension_slope(q, Register(L), l).store(results[1]);
        Buckling::stiffness_bound(q, Register(L)).store(results[2]);
        const auto same = [](TestType a, TestType b) { return a == b || (a != a && b != b); };
        for (int lane = 0; lane < Register::width; ++lane) {
            const TestType length = lengths[lane + trial % 5];
            CHECK(same(results[0][lane], Buckling::tension(p, L, length)));
            CHECK(same(results[1][lane], Buckling::tension_slope(p, L, length)));
            CHECK(same(results[2][lane], Buckling::stiffness_bound(p, L)));
        }
    }
}
#endif

TEST_CASE("buckling: the beam is the published formula, with its limits at l = L and l = 0",
          "[network]") {
    Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const double kb = random.uniform(0.1, 10);
        const double L = random.uniform(0.2, 2);
        const double y = random.uniform(0.3, 3.1);  // κL/2
        const double l = L * std::sin(y) / y;
        const double kappa = 2 * y / L;
        const double published = kb * kappa * kappa / (std::cos(y) - std::sin(y) / y);
        CHECK_THAT(Buckling::tension(beam_alone(kb), L, l), WithinRel(published, 1e-12));
        const auto p = beam_alone(kb);
        const double pi = static_cast<double>(EIGEN_PI);
        CHECK_THAT(Buckling::tension(p, L, L * (1 - 1e-7)), WithinRel(-12 * kb / (L * L), 1e-6));
        CHECK_THAT(Buckling::tension(p, L, L * 1e-9), WithinRel(-4 * pi * pi * kb / (L * L), 1e-6));
    }
}

TEST_CASE("buckling: along the beam the energy is that of bending an arc, k_b kappa^2 L/2",
          "[network]") {
    const double kb = 3;
    const double L = 0.7;
    const auto p = beam_alone(kb);
    const auto bending = [&](double y) { return 2 * kb * y * y / L; };
    const auto energy = [&](double y) { return Buckling::energy(p, L, L * std::sin(y) / y); };
    for (const double y : {0.5, 1.0, 2.0, 3.0}) {
        CHECK_THAT(energy(y) - energy(0.25), WithinRel(bending(y) - bending(0.25), 1e-10));
    }
}

TEST_CASE("buckling: tension is the integral's slope and rises with length across every kink",
          "[network]") {
    Random random(2);
    for (const double c : {2.0, 7.8, 7.88, 9.0, 9.8, 10.5, 100.0, 1e6}) {
        const double L = random.uniform(0.3, 2);
        const auto p = with_onset(c, random.uniform(0.1, 5), L);
        const double unit = 4 * p.bending / (L * L);
        double before = Buckling::tension(p, L, 1e-12 * L);
        double integral = 0;
        const int panels = 20000;
        const double start = Buckling::energy(p, L, 1e-12 * L);
        for (int i = 0; i < panels; ++i) {
            const double a = L * (1e-12 + 1.1 * i / panels);
            const double b = L * (1e-12 + 1.1 * (i + 1) / panels);
            // Simpson; a kink inside a panel costs its jump of slope times the panel squared.
            const double at_b = Buckling::tension(p, L, b);
            integral += (b - a) / 6 * (before + 4 * Buckling::tension(p, L, (a + b) / 2) + at_b);
            const double bound = Buckling::stiffness_bound(p, L);
            REQUIRE(at_b >= before);
            REQUIRE(at_b - before <= bound * (b - a) * (1 + 1e-9) + 1e-12 * unit);
            before = at_b;
            const double energy = Buckling::energy(p, L, b);
            REQUIRE_THAT(energy - start - integral,
                         WithinAbs(0, 1e-8 * (bound * (b - a) * (b - a) * 1e8 + unit * L)));
        }
    }
}

TEMPLATE_TEST_CASE("buckling: at l = L its slope is the stiffness, one ulp below it the onset",
                   "[network]", float, double, long double) {
    Random random(4);
    for (const double c : {2.0, 7.88, 9.8, 10.5, 100.0, 1e6}) {
        const double length = random.uniform(0.3, 2);
        const auto q = with_onset(c, random.uniform(0.1, 5), length);
        const auto p = q.cast<TestType>();
        const auto L = static_cast<TestType>(length);
        const TestType below = std::nextafter(L, TestType(0));
        CHECK(Buckling::tension_slope(p, L, std::nextafter(L, TestType(4))) == p.stiffness);
        CHECK(Buckling::tension_slope(p, L, L) == p.stiffness);
        CHECK(Buckling::tension_slope(p, L, below) == p.onset);
        CHECK(Buckling::tension(p, L, L) == 0);
        CHECK(Buckling::tension(p, L, below) == p.onset * (below - L));
    }
}

TEST_CASE("buckling: just past each crossing the slope is that of the curve which took over",
          "[network]") {
    using Long = long double;
    Random random(5);
    int crossings = 0;
    for (int trial = 0; trial < 200; ++trial) {
        // Below π² the line comes back as the ends meet, above it never does.
        const double c = trial % 2 == 0 ? random.uniform(7.95, 9.8) : random.uniform(10, 1000);
        const double L = random.uniform(0.3, 2);
        const auto p = with_onset(c, random.uniform(0.1, 5), L);
        const auto on_line = [&](double l) {
            return Buckling::tension(p, L, l) == p.onset * (l - L);
        };
        // One crossing is above the length at which the beam is the furthest from the line, w =
        // 5.782; the other one below.
        const double furthest = L * (1 - 0.7205);
        REQUIRE_FALSE(on_line(furthest));
        for (const double end : {L * (1 - 1e-12), L * 1e-6}) {
            if (!on_line(end)) continue;
            ++crossings;
            double line = end;
            double beam = furthest;
            while (std::abs(line - beam) > 4e-16 * L) {
                const double middle = (line + beam) / 2;
                (on_line(middle) ? line : beam) = middle;
            }
            const double beyond = beam + (beam < line ? -1e-9 : 1e-9) * L;
            const double before = line + (beam < line ? 1e-9 : -1e-9) * L;
            CHECK(Buckling::tension_slope(p, L, before) == p.onset);
            const auto [least, most] =
                Buckling::slope_range(p, L, std::min(before, furthest), std::max(before, furthest));
            const double slope = Buckling::tension_slope(p, L, beyond);
            CHECK((slope >= least * (1 - 1e-6) && slope <= most * (1 + 1e-6)));
            // The beam's own slope, from both sides of a point on it in long double.
            const auto q = p.cast<Long>();
            const Long step = 1e-10L * L;
            const Long rise = Buckling::tension(q, Long(L), Long(beyond) + step) -
                              Buckling::tension(q, Long(L), Long(beyond) - step);
            CHECK_THAT(slope, WithinRel(static_cast<double>(rise / (2 * step)), 1e-5));
        }
    }
    CHECK(crossings >= 250);
}

TEST_CASE("buckling: the beam shows exactly where the bound counts it", "[network]") {
    const double L = 0.8;
    for (const double c : {7.8, 7.86}) {  // the line is never exceeded
        const auto p = with_onset(c, 2, L);
        for (int i = 1; i < 1000; ++i) {
            const double l = L * i / 1000;
            REQUIRE(Buckling::tension(p, L, l) == p.onset * (l - L));
        }
        CHECK(Buckling::stiffness_bound(p, L) == std::max(p.onset, p.stiffness));
    }
    const auto p = with_onset(7.875, 2, L);
    CHECK(Buckling::tension(p, L, L * (1 - 0.7205)) > p.onset * L * -0.7205);
    CHECK(Buckling::stiffness_bound(p, L) > 2 * p.onset);
}

TEMPLATE_TEST_CASE("buckling: without length, bending or onset it stays finite", "[network]", float,
                   double) {
    const Parameters<TestType> full{100, 2, 300};
    const Parameters<TestType> limp{100, 0, 300};
    const Parameters<TestType> no_onset{100, 2, 0};
    const TestType L(0.5);
    CHECK(Buckling::tension(full, TestType(0), L) == TestType(50));
    CHECK(Buckling::energy(full, TestType(0), TestType(0)) == 0);
    CHECK(Buckling::stiffness_bound(full, TestType(0)) == 300);
    CHECK(std::isfinite(Buckling::energy(full, L, TestType(0))));
    CHECK(Buckling::tension(limp, L, TestType(0.25)) == 0);
    CHECK(Buckling::energy(limp, L, TestType(0.25)) == 0);
    CHECK(Buckling::tension(no_onset, L, TestType(0.25)) == 0);
    CHECK(Buckling::energy(no_onset, L, TestType(0.25)) == 0);
}

}  // namespace taut_test::buckling_test
