// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/core/types.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::held_as_test {

namespace {

struct Pair {
    double first, second;
};

#if defined(__GNUC__) && !defined(__clang__)
__attribute__((noinline, optimize("O3")))
#endif
void hold(const Pair& values, Pair& held) {
    held = {taut::held_as<float>(values.first), taut::held_as<float>(values.second)};
}

}  // namespace

TEST_CASE("held_as: neighbours are rounded too when the optimizer takes them together", "[core]") {
    Random random(20);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const float first = static_cast<float>(random.uniform(1, 2));
        const float second = static_cast<float>(random.uniform(1, 2));
        const double between = 1e-8 * random.uniform(0, 1);  // less than half of a float's last bit
        Pair held{};
        hold({static_cast<double>(first) + between, static_cast<double>(second) + between}, held);
        CHECK(held.first == static_cast<double>(first));
        CHECK(held.second == static_cast<double>(second));
        CHECK(taut::held_as<double>(between) == between);
    }
}

}  // namespace taut_test::held_as_test
