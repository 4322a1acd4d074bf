// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Baraff and Witkin's cloth: steps of a frame, particles held by constraints, the force that this
// takes, and a step size that adapts. docs/systems/large_steps.md reads along.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <taut/constraints/constraints.hpp>
#include <taut/taut.hpp>

using Cloth = taut::SpringSystem<double, 3>;
using State = Cloth::State;

/// The largest change of a spring's length between two states, of its rest length.
double stretch_change(const Cloth& cloth, const State& before, const State& after) {
    double most = 0;
    for (const auto spring : cloth.springs()) {
        const double was = (before.x.col(spring.b) - before.x.col(spring.a)).norm();
        const double is = (after.x.col(spring.b) - after.x.col(spring.a)).norm();
        most = std::max(most, std::abs(is - was) / spring.rest_length);
    }
    return most;
}

/// Their step size: a step that fails, or stretches a spring by more than a tenth, is taken back
/// and tried with half of h; after four that did not, h doubles again.
struct AdaptiveStep {
    double h = 1.0 / 60, longest = 1.0 / 60, shortest = 1e-6;  // s
    int taken = 0, rejected = 0, in_a_row = 0;

    template <class Stepper>
    bool advance(const Cloth& cloth, Stepper& stepper, State& state, double duration) {
        const double end = state.time + duration;
        while (end - state.time > shortest / 2) {
            const State before = state;
            const double step = std::min(h, end - state.time);
            const bool good = bool(stepper.step(state, step));
            if (good && (step <= shortest || stretch_change(cloth, before, state) <= 0.1)) {
                ++taken;
                if (++in_a_row % 4 == 0) h = std::min(2 * h, longest);
                continue;
            }
            if (step <= shortest) return false;
            state = before;
            h = std::max(step / 2, shortest);
            ++rejected;
            in_a_row = 0;
        }
        return true;
    }
};

int main() {
    auto options = taut::ClothOptions{24, 24};
    options.pin_corners = false;
    const auto cloth = taut::hanging_cloth<double>(options);
    auto state = cloth.initial_state();

    taut::ConstrainedEuler stepper(cloth);
    stepper.constraints().fix(0);
    stepper.constraints().hold_on_line(23, {1, 0, 0});  // a ring on a rod along x
    if (!stepper.step(state, 1.0 / 60, 120)) return 1;
    const Eigen::Vector3d pull = stepper.constraint_forces().col(0);
    std::printf("particle 0 is held by %.2f N, of which %.2f N upwards\n", pull.norm(), pull[2]);
    std::printf("the ring is %.1e m off its rod\n", state.x.col(23).tail<2>().norm());

    stepper.constraints().release(23);
    AdaptiveStep adaptive;
    if (!adaptive.advance(cloth, stepper, state, 0.5)) return 1;
    std::printf("released: %d steps in 0.5 s, %d taken back\n", adaptive.taken, adaptive.rejected);
}
