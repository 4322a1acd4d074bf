// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/implicit_euler.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/direct_euler.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::implicit_default_test {

using taut::ImplicitEuler;

TEMPLATE_TEST_CASE("implicit_euler: the default solver errs far less than the step does",
                   "[integrator]", float, double) {
    for (const double stretch : {1e2, 1e3, 1e5}) {
        for (const double step : {1.0 / 60, 1.0 / 240}) {
            INFO("stretch " << stretch << ", h " << step);
            taut::ClothOptions options{10, 12};
            options.stretch = stretch;
            options.bend = stretch / 10;
            const auto cloth = taut::hanging_cloth<TestType>(options);
            const auto h = static_cast<TestType>(step);
            auto state = cloth.initial_state();
            ImplicitEuler by_default(cloth);
            for (int k = 0; k < 30; ++k) {
                auto exact = state;
                auto fine = state;
                DirectEuler direct(cloth);
                REQUIRE(direct.step(exact, h));
                REQUIRE(direct.step(fine, h / 8, 8));
                REQUIRE(by_default.step(state, h));
                CHECK(distance(state.x, exact.x) <= 0.2 * distance(exact.x, fine.x));
            }
        }
    }
}

}  // namespace taut_test::implicit_default_test
