// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
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

}  // namespace taut_test::number_test
