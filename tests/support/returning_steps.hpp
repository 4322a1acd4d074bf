// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

namespace taut_test {

/// Steps h, s, to be taken in turn, and how many factorisations a stepper has made by then that
/// keeps those of the last two h.
inline constexpr std::pair<double, int> returning_steps[] = {
    {0.01, 1}, {0.01, 1}, {0.005, 2}, {0.01, 2}, {0.005, 2}, {0.002, 3}, {0.005, 3}, {0.01, 4}};

}  // namespace taut_test
