// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Steps of a cloth without damping, pins or a second law, by Taut or by the loop that one would
// write by hand: `lean_step taut|plain STEPS`, for lean_step.sh to count instructions.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <taut/scene/cloth.hpp>

#include "lean/steps.hpp"

int main(int argc, char** argv) {
    if (argc != 3) return 1;
    taut::ClothOptions options;
    options.rows = options.columns = 32;
    options.pin_corners = false;
    const auto cloth = taut::hanging_cloth<double>(options);
    const int steps = std::atoi(argv[2]);
    constexpr double h = 1e-4;
    if (std::strcmp(argv[1], "plain") == 0) {
        bench::PlainLoop<double> plain(cloth);
        bench::plain_steps(plain, h, steps);
        return 0;
    }
    auto state = cloth.initial_state();
    taut::SymplecticEuler stepper(cloth);
    const auto report = bench::taut_steps(stepper, state, h, steps);
    if (!report) std::puts(describe(report.status));
    return report ? 0 : 1;
}
