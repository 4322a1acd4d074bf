// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "../../examples/common/number.hpp"
#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::number_test {

using example::read_quantity;

namespace {

const std::vector<example::Unit> times{{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}};

}  // namespace

TEST_CASE("number: a quantity is its number, or its fraction, times its unit", "[programs]") {
    Random random(4);
    const char* blanks[] = {"", " ", "  "};
    for (int trial = 0; trial < 500; ++trial) {
        const double above = random.uniform(-10, 10) * std::pow(10, random.below(12) - 6);
        const double below = random.uniform(0.1, 300);
        const auto unit = static_cast<std::size_t>(random.below(4));
        char text[120];
        const bool fraction = trial % 2 == 0;
        const char* blank = blanks[random.below(3)];
        if (fraction) {
            std::snprintf(text, sizeof text, "%.17g%s/%s%.17g", above, blank, blank, below);
        } else {
            std::snprintf(text, sizeof text, "%.17g", above);
        }
        const std::string name = unit < 3 ? std::string(times[unit].name) : "";
        double value = -1;
        REQUIRE(read_quantity(blank + std::string(text) + blank + name + blank, times, value));
        const double worth = unit < 3 ? times[unit].worth : 1;
        CHECK(value == (fraction ? above / below : above / 1) * worth);
    }
}

TEST_CASE("number: bad input: what is no quantity as a whole is none", "[programs][bad_input]") {
    double value = 0;
    for (const char* text : {"",     " ",     "s",    "1/",  "/2",     "1/2/3", "1/0", "0/0",
                             "1//2", "0x10",  "1e",   "1 m", "1min",   "1s2",   "ms1", "nan",
                             "inf",  "1e999", "1..2", "1 2", "1/2s/3", "1,5",   "--1", "1e-3e"}) {
        CAPTURE(text);
        CHECK_FALSE(read_quantity(text, times, value));
    }
    CHECK(read_quantity("1e-3", times, value));
    CHECK(value == 1e-3);
    CHECK_FALSE(read_quantity("1s", {}, value));
}

TEST_CASE("number: a bound as text is on its side, and the nearest text there", "[programs]") {
    Random random(11);
    const auto read = [](const std::string& text) { return std::strtod(text.c_str(), nullptr); };
    int moved = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        double value = random.uniform(0.1, 1) * std::pow(10, random.below(40) - 30);
        if (trial % 5 == 0) value = std::nextafter(std::pow(10, random.below(9) - 6), trial % 2);
        if (trial % 7 == 0) value = static_cast<double>(static_cast<float>(value));
        if (trial % 50 == 0) value = std::numeric_limits<double>::denorm_min() * trial;
        const int digits = 1 + static_cast<int>(random.below(15));
        const char style = trial % 2 == 0 ? 'e' : 'g';
        const std::string down = example::rounded_down(value, digits, style);
        const std::string up = example::rounded_up(value, digits, style);
        CAPTURE(value, digits, style, down, up);
        REQUIRE(read(down) <= value);
        REQUIRE(read(up) >= value);
        if (static_cast<double>(static_cast<float>(value)) == value)
            REQUIRE(std::strtof(down.c_str(), nullptr) <= static_cast<float>(value));
        // The two sides are the same text or neighbours, of which printf takes the nearer one.
        char nearest[64];
        std::snprintf(nearest, sizeof nearest, style == 'e' ? "%.*e" : "%.*g",
                      style == 'e' ? digits - 1 : digits, value);
        REQUIRE((down == nearest || up == nearest));
        const double unit = std::pow(10, std::floor(std::log10(value * 1.0000001)) - digits + 1);
        if (value > 1e-300 && digits < 14) REQUIRE(read(up) - read(down) <= 1.01 * unit);
        moved += down != nearest;
        REQUIRE(example::rounded_down(-value, digits, style) == '-' + up);
    }
    REQUIRE(moved > 1000);  // nearest would have been too large
    REQUIRE(example::rounded_down(0, 5) == "0.0000e+00");
    REQUIRE(example::rounded_down(HUGE_VAL, 5) == "inf");
    REQUIRE(read(example::rounded_up(std::numeric_limits<double>::max(), 3)) == HUGE_VAL);
}

}  // namespace taut_test::number_test
