// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/core/detail/bisection.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::bisection_test {

using taut::detail::Bisection;
using taut::detail::last_that_passes;

namespace {

template <class Real>
using Limits = std::numeric_limits<Real>;

/// Any positive normal number, each exponent as likely.
template <class Real>
Real anywhere(Random& random) {
    const auto binades =
        static_cast<Index>(Limits<Real>::max_exponent - Limits<Real>::min_exponent);
    const auto exponent = Limits<Real>::min_exponent + static_cast<int>(random.below(binades));
    return std::scalbn(static_cast<Real>(random.uniform(0.5, 1)), exponent);
}

/// How many tests a search took; it fails if there are more than any search may take.
template <class Real, class Test>
int search_out(Bisection<Real>& search, Test&& test) {
    int tests = 0;
    while (search.open()) {
        const Real middle = search.middle();
        REQUIRE(middle > std::min(search.passes(), search.fails()));
        REQUIRE(middle < std::max(search.passes(), search.fails()));
        search.narrow(test(middle));
        REQUIRE(++tests <= Bisection<Real>::most_halvings);
    }
    return tests;
}

}  // namespace

TEMPLATE_TEST_CASE("bisection: the border between any two numbers, in either order", "[core]",
                   float, double, long double) {
    Random random(400);
    for (int repeat = 0; repeat < 3000; ++repeat) {
        TestType low = anywhere<TestType>(random);
        TestType high = anywhere<TestType>(random);
        TestType border = anywhere<TestType>(random);
        if (repeat % 3 == 0) high = low * static_cast<TestType>(random.uniform(1, 5));
        if (low > high) std::swap(low, high);
        if (!(high < Limits<TestType>::max())) continue;
        border = std::clamp(border, low, high);
        const bool upwards = repeat % 2 == 0;
        const auto test = [&](TestType x) { return upwards ? x <= border : x >= border; };
        const TestType start = upwards ? low : high;
        const TestType end = upwards ? high : low;
        for (const double tolerance : {0.0, 1e-4}) {
            Bisection<TestType> search(start, end, static_cast<TestType>(tolerance));
            search_out(search, test);
            INFO("from " << start << " to " << end << ", border " << border);
            CHECK((search.passes() == start || test(search.passes())));
            CHECK((search.fails() == end || !test(search.fails())));
            const TestType a = std::min(search.passes(), search.fails());
            const TestType b = std::max(search.passes(), search.fails());
            // Neighbours, or as close as asked for.
            CHECK((std::nextafter(a, b) >= b || b - a <= static_cast<TestType>(tolerance) * a));
        }
    }
}

TEMPLATE_TEST_CASE("bisection: it ends whatever the points are", "[core]", float, double) {
    constexpr TestType ends[] = {0,
                                 Limits<TestType>::denorm_min(),
                                 Limits<TestType>::min(),
                                 1,
                                 Limits<TestType>::max(),
                                 Limits<TestType>::infinity(),
                                 Limits<TestType>::quiet_NaN()};
    for (const TestType passes : ends) {
        for (const TestType fails : ends) {
            for (const bool answer : {false, true}) {
                Bisection<TestType> search(passes, fails, 0);
                search_out(search, [&](TestType) { return answer; });
                Bisection<TestType> nowhere(passes, fails, Limits<TestType>::quiet_NaN());
                CHECK_FALSE(nowhere.open());
            }
        }
    }
    // No more than it was given.
    Bisection<TestType> search(0, 1, 0, 7);
    CHECK(search_out(search, [](TestType) { return false; }) == 7);
    CHECK(search.fails() == std::scalbn(TestType(1), -7));
    CHECK(search.passes() == 0);
}

TEMPLATE_TEST_CASE("bisection: the last number that passes, from any guess", "[core]", float,
                   double) {
    Random random(401);
    const TestType tolerance = std::sqrt(Limits<TestType>::epsilon());
    for (int repeat = 0; repeat < 2000; ++repeat) {
        const TestType border = anywhere<TestType>(random);
        const TestType guess = anywhere<TestType>(random);
        int tests = 0;
        const TestType found = last_that_passes(guess, tolerance, [&](TestType x) {
            ++tests;
            return x <= border;
        });
        INFO("border " << border << ", guess " << guess);
        CHECK(found <= border);
        CHECK(border - found <= tolerance * border);
        CHECK(tests <= 80);
    }
    for (const TestType guess : {TestType(0), TestType(1), Limits<TestType>::max(),
                                 Limits<TestType>::infinity(), Limits<TestType>::quiet_NaN()}) {
        const auto always = [](TestType) { return true; };
        const auto never = [](TestType) { return false; };
        CHECK(last_that_passes(guess, tolerance, always) == Limits<TestType>::infinity());
        CHECK(last_that_passes(guess, tolerance, never) == 0);
    }
}

}  // namespace taut_test::bisection_test
