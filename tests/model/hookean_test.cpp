// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/model/hookean.hpp>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::hookean_test {

namespace {

/// A length away from l = L, where the slope of a tension-only spring jumps.
double draw_length(Random& random, double L) {
    const double offset = random.uniform(0.01, 0.6);
    return offset < L && random.below(2) == 0 ? L - offset + 1e-3 : L + offset;
}

}  // namespace

TEMPLATE_TEST_CASE("law: tension is the derivative of energy, and tension_slope that of tension",
                   "[model]", taut::Hookean, TensionOnly, Glue) {
    Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const auto p = draw_parameters<double>(random, TestType{});
        const double L = random.uniform(0.2, 1.5);
        const double l = draw_length(random, L);
        const double h = 1e-5;
        const double k = p.stiffness;
        CHECK_THAT((TestType::energy(p, L, l + h) - TestType::energy(p, L, l - h)) / (2 * h),
                   Catch::Matchers::WithinAbs(TestType::tension(p, L, l),
                                              Tolerance<double>::difference * k));
        CHECK_THAT((TestType::tension(p, L, l + h) - TestType::tension(p, L, l - h)) / (2 * h),
                   Catch::Matchers::WithinAbs(TestType::tension_slope(p, L, l),
                                              Tolerance<double>::difference * k));
    }
}

TEMPLATE_TEST_CASE("law: stiffness_bound is at least T'(l) and T(l)/l at every length", "[model]",
                   taut::Hookean, TensionOnly, Glue, Buckling) {
    Random random(2);
    for (int trial = 0; trial < 500; ++trial) {
        const auto p = draw_parameters<double>(random, TestType{});
        const double L = trial % 5 == 0 ? 0 : random.uniform(0, 1.5);
        const double l = trial % 3 == 0 ? random.uniform(1e-6, 1e-3) : random.uniform(0.01, 20);
        const double bound = TestType::stiffness_bound(p, L) * (1 + Tolerance<double>::rounding);
        CHECK(TestType::tension_slope(p, L, l) <= bound);
        CHECK(TestType::tension(p, L, l) / l <= bound);
    }
}

TEMPLATE_TEST_CASE("law: an unstretched spring pulls with no force and holds no energy", "[model]",
                   taut::Hookean, TensionOnly, Glue, Buckling) {
    Random random(3);
    const auto p = draw_parameters<double>(random, TestType{});
    for (const double L : {0.1, 1.0, 3.7}) {
        CHECK(TestType::tension(p, L, L) == 0);
        CHECK(TestType::energy(p, L, L) == 0);
    }
}

TEST_CASE("hookean: one spring by hand", "[model]") {
    const taut::Hookean::Parameters<double> p{1000};
    CHECK_THAT(taut::Hookean::tension(p, 0.5, 0.75),
               Catch::Matchers::WithinRel(250.0, Tolerance<double>::rounding));
    CHECK_THAT(taut::Hookean::tension(p, 0.5, 0.25),
               Catch::Matchers::WithinRel(-250.0, Tolerance<double>::rounding));
    CHECK_THAT(taut::Hookean::energy(p, 0.5, 0.75),
               Catch::Matchers::WithinRel(31.25, Tolerance<double>::rounding));
    CHECK(taut::Hookean::tension_slope(p, 0.5, 0.75) == 1000);
    CHECK(taut::Hookean::stiffness_bound(p, 0.5) == 1000);
}

TEST_CASE("hookean: a negative or not finite stiffness is refused by name", "[model]") {
    const double bad = GENERATE(-1.0, std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN());
    const taut::Hookean::Parameters<double> p{bad};
    CHECK(missing(message_of([&] { p.require_valid("add_spring(3, 7)"); }),
                  {"add_spring(3, 7)", "stiffness is ", ">= 0"}) == "");
}

TEST_CASE("hookean: parameters change their precision without changing their value", "[model]") {
    const taut::Hookean::Parameters<float> p{0.1F};
    CHECK(p.cast<double>().stiffness == static_cast<double>(0.1F));
}

}  // namespace taut_test::hookean_test
