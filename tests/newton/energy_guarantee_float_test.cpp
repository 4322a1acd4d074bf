// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "energy_guarantee.hpp"

namespace taut_test::energy_guarantee_test {

TEMPLATE_TEST_CASE(
    "energy_guarantee: a converged implicit step keeps the promise of [T24], in float",
    "[model][slow]", (Case<float, 1>), (Case<float, 2>), (Case<float, 3>)) {
    check_promise<TestType>();
}

}  // namespace taut_test::energy_guarantee_test
