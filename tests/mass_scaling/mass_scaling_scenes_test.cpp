// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "scenes.hpp"

namespace taut_test::mass_scaling_test {

TEST_CASE(
    "mass_scaling: with the mass added the step is certified, and none is where it is already",
    "[mass_scaling][slow]") {
    check_scenes<1, 2>();
}

}  // namespace taut_test::mass_scaling_test
