// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/network/buckling.hpp>
#include <taut/network/hookean.hpp>
#include <taut/network/spring_set.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::spring_set_test {

using taut::Hookean;
using taut::SpringSet;
using Set = SpringSet<double, Hookean>;

TEST_CASE(
    "spring_set: damping takes no memory until a damped spring comes, and counts from then on",
    "[network]") {
    Set set;
    set.add({0, 1, {10}, 1});
    set.add({1, 2, {10}, 1});
    CHECK(set.damping.empty());
    CHECK(set.damping_of(1) == 0);
    set.add({2, 3, {10}, 1, 5});
    set.add({3, 4, {10}, 1});
    CHECK(std::vector<double>(set.damping.begin(), set.damping.end()) ==
          std::vector<double>{0, 0, 5, 0});
    CHECK(set.damping_of(2) == 5);
    CHECK(set.size() == 4);
}

TEST_CASE("spring_set: a loop over a set meets its springs in their order", "[network]") {
    Random random(610);
    for (const int count : {0, 1, 20}) {
        Set set;
        for (int s = 0; s < count; ++s)
            set.add({s, s + 1, {random.uniform(1, 9)}, random.uniform(0, 1), s % 3 == 0 ? 2.0 : 0});
        std::size_t s = 0;
        for (const auto spring : set) {
            CHECK(spring.a == set.a[s]);
            CHECK(spring.b == set.b[s]);
            CHECK(spring.parameters.stiffness == set.parameters[s].stiffness);
            CHECK(spring.rest_length == set.rest_length[s]);
            CHECK(spring.damping == set.damping_of(s++));
        }
        CHECK(static_cast<int>(s) == count);
    }
}

TEST_CASE("spring_set: the tangent of a stretched, a compressed and a flat spring by hand",
          "[network]") {
    Set set;
    set.add({0, 1, {100}, 4, 7});
    taut::Points<double, 2> x(2, 2);
    x << 0, 0, 0, 5;
    const auto long_one = set.tangent(0, x);
    CHECK((long_one.d == Eigen::Vector2d(0, 1)));
    CHECK(long_one.axial == 100);
    CHECK_THAT(long_one.transverse, Catch::Matchers::WithinRel(20.0, Tolerance<double>::rounding));
    CHECK(long_one.bound == 100);
    CHECK(long_one.damping == 7);

    x(1, 1) = -2;
    const auto short_one = set.tangent(0, x);
    CHECK((short_one.d == Eigen::Vector2d(0, -1)));
    CHECK_THAT(short_one.transverse,
               Catch::Matchers::WithinRel(-100.0, Tolerance<double>::rounding));
    CHECK(short_one.projected().transverse == 0);
    CHECK(short_one.projected().axial == 100);

    x(1, 1) = 0;
    const auto flat = set.tangent(0, x);
    CHECK((flat.d == Eigen::Vector2d(0, 0)));
    CHECK(flat.axial == 100);
    CHECK(flat.transverse == 100);
}

TEST_CASE("spring_set: a float spring has a tangent in double", "[network]") {
    SpringSet<float, Hookean> set;
    set.add({0, 1, {0.1F}, 0.3F});
    taut::Points<double, 1> x(1, 2);
    x << 0, 0.7;
    const auto t = set.tangent(0, x);
    CHECK(t.axial == static_cast<double>(0.1F));
    const double expected = static_cast<double>(0.1F) * (1 - static_cast<double>(0.3F) / 0.7);
    CHECK_THAT(t.transverse, Catch::Matchers::WithinRel(expected, Tolerance<double>::rounding));
}

TEMPLATE_TEST_CASE("spring_set: a block times a vector is its product", "[network]",
                   (Case<float, 2>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    using Vector = Eigen::Matrix<Scalar, TestType::Dim, 1>;
    Random random(2003);
    for (int trial = 0; trial < 100; ++trial) {
        CAPTURE(trial);
        const Vector d = random.vector<Scalar, TestType::Dim>(-1, 1).normalized();
        const Vector u = random.vector<Scalar, TestType::Dim>(-2, 2);
        const auto axial = static_cast<Scalar>(random.uniform(-100, 100));
        const auto transverse = static_cast<Scalar>(random.uniform(-100, 100));
        const auto H = taut::spring_block(d, axial, transverse);
        CHECK((H == H.transpose()));
        CHECK(distance(taut::spring_product(d, axial, transverse, u), H * u) <=
              400 * Tolerance<Scalar>::rounding);
        // Without a damper it does not matter how the ends move.
        const taut::Spring<Scalar, Hookean> spring{0, 1, {std::abs(axial)}, Scalar(1)};
        CHECK((pull(spring, u, d, Scalar(0)) == pull(spring, u)));
        const Vector nothing = Vector::Zero();
        CHECK((pull(spring, nothing) == nothing));
        CHECK(taut::spring_length(nothing) > 0);
    }
}

// T' = k sin(l)/l: of a length, no number at 0.
struct Sinc : Hookean {
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar, Scalar l) {
        return p.stiffness * std::sin(l) / l;
    }
};

TEST_CASE("spring_set: axial_range asks a law for lengths alone", "[network]") {
    Random random(1402);
    for (int repeat = 0; repeat < 100; ++repeat) {
        SpringSet<float, Sinc> set;
        set.add({0, 1, {10}, 1});
        const double origin = log_uniform(random, 1e4, 1e7);
        taut::Points<double, 1> x(1, 2);
        x << origin, origin + log_uniform(random, 1e-3, 1);
        const auto [softer, stiffer] = set.axial_range(0, x, set.tangent(0, x));
        CAPTURE(origin, softer, stiffer);
        CHECK(std::isfinite(softer));
        CHECK(stiffer <= 10);
    }
}

// Far from the origin rounding reaches across the kinks of Buckling: what lies between two of them,
// the line or the end of the arc, may be the stiffest of all.
TEMPLATE_TEST_CASE("spring_set: every slope within rounding is in axial_range", "[network]", float,
                   double) {
    Random random(1401);
    int between = 0;
    for (int repeat = 0; repeat < 2000; ++repeat) {
        SpringSet<TestType, taut::Buckling> set;
        const auto onset = static_cast<TestType>(log_uniform(random, 1, 1e6));
        const auto bending =
            static_cast<TestType>(static_cast<double>(onset) * log_uniform(random, 1e-16, 1e-2));
        const auto L = static_cast<TestType>(random.uniform(0.5, 2));
        set.add({0, 1, {1, bending, onset}, L});
        const double origin = log_uniform(random, 1e-3, 1e5);
        const double reach = 4 * static_cast<double>(std::numeric_limits<TestType>::epsilon()) *
                             (2 * origin + 2 * static_cast<double>(L));
        taut::Points<double, 1> x(1, 2);
        const double shortened = repeat % 2 == 0 ? 1 : random.uniform(0.05, 1);
        const double about = static_cast<double>(L) * shortened;
        x << origin, origin + about + reach * random.uniform(-1, 1);
        const double l = x(0, 1) - x(0, 0);
        const auto [softer, stiffer] = set.axial_range(0, x, set.tangent(0, x));
        const auto p = set.parameters[0].template cast<double>();
        const double rest = static_cast<double>(L);
        double least = stiffer, most = softer;
        for (int i = -50; i <= 51; ++i) {
            const double at = i > 50 ? std::nextafter(rest, 0.0) : l + reach * i / 50;
            if (!(at > 0) || std::abs(at - l) > reach) continue;
            const double slope = taut::Buckling::tension_slope(p, rest, at);
            least = std::min(least, slope);
            most = std::max(most, slope);
        }
        CAPTURE(repeat, onset, bending, origin, l - rest);
        const double rounding = 1e-12 * taut::Buckling::stiffness_bound(p, rest);
        CHECK(most <= stiffer + rounding);
        CHECK(least >= softer - rounding);
        between +=
            12 * static_cast<double>(bending) / (rest * rest) / static_cast<double>(onset) < reach;
    }
    REQUIRE(between > 200);
}

}  // namespace taut_test::spring_set_test
