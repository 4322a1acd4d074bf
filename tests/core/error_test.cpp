// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/core/error.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"

namespace taut_test::error_test {

TEST_CASE("error: fail joins words and numbers to one sentence", "[core]") {
    const auto message =
        message_of([] { taut::fail("f", ": x[", 3, "] is ", -0.5, "; ", std::string("no")); });
    CHECK(message == "taut::f: x[3] is -0.5; no");
}

TEST_CASE("error: numbers in messages keep nine digits, and NaN and infinity have names",
          "[core]") {
    CHECK(missing(message_of([] { taut::fail(0.123456789); }), {"0.123456789"}) == "");
    CHECK(missing(message_of([] { taut::fail(1e300); }), {"1e+300"}) == "");
    CHECK(missing(message_of([] { taut::fail(std::numeric_limits<float>::infinity()); }),
                  {"inf"}) == "");
    CHECK(missing(message_of([] { taut::fail(std::numeric_limits<double>::quiet_NaN()); }),
                  {"nan"}) == "");
    CHECK(missing(message_of([] { taut::fail(std::numeric_limits<long long>::min()); }),
                  {"-9223372036854775808"}) == "");
    CHECK(missing(message_of([] { taut::fail(std::numeric_limits<unsigned long long>::max()); }),
                  {"18446744073709551615"}) == "");
}

TEMPLATE_TEST_CASE(
    "error: require_non_negative takes zero and every positive number, and nothing else", "[core]",
    float, double) {
    using Limits = std::numeric_limits<TestType>;
    const auto check = [](TestType value) {
        return message_of([&] { taut::require_non_negative("Law", "stiffness", value); });
    };
    for (const TestType good : {TestType(0), Limits::denorm_min(), TestType(1), Limits::max()}) {
        CHECK(check(good) == "");
    }
    for (const TestType bad : {-Limits::denorm_min(), TestType(-1), Limits::infinity(),
                               -Limits::infinity(), Limits::quiet_NaN()}) {
        CHECK(missing(check(bad), {"taut::Law", "stiffness is ", "finite and >= 0"}) == "");
    }
    CHECK(missing(check(TestType(-2.5)), {"-2.5"}) == "");
}

}  // namespace taut_test::error_test
