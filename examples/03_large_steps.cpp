// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Baraff and Witkin's cloth: steps of a frame, particles held by constraints, the force that this
// takes, and a step size that adapts. docs/systems/large_steps.md reads along.

#include <cstdio>
#include <taut/integrator/adaptive.hpp>
#include <taut/taut.hpp>

int main() {
    auto options = taut::ClothOptions{24, 24};
    options.pin_corners = false;
    const auto cloth = taut::hanging_cloth<double>(options);
    auto state = cloth.initial_state();

    taut::ImplicitEuler stepper(cloth);
    stepper.constraints().fix(0);
    stepper.constraints().hold_on_line(23, {1, 0, 0});  // a ring on a rod along x
    if (!stepper.step(state, 1.0 / 60, 120)) return 1;
    const Eigen::Vector3d pull = stepper.constraint_forces().col(0);
    std::printf("particle 0 is held by %.2f N, of which %.2f N upwards\n", pull.norm(), pull[2]);
    std::printf("the ring is %.1e m off its rod\n", state.x.col(23).tail<2>().norm());

    taut::Adaptive adaptive(cloth, stepper);
    stepper.constraints().release(23);
    const auto report = adaptive.advance(state, 0.5);
    if (!report) return 1;
    std::printf("released: %d steps in 0.5 s, %d taken back\n", static_cast<int>(report.steps),
                static_cast<int>(report.rejected));
}
