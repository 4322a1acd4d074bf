// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "scene.hpp"

namespace taut_test {

/// What a stepper promises, for test_stepper to hold it to.
struct StepperBattery {
    std::function<std::unique_ptr<AnyStepper>(const Scene&)> make;
    /// The scenes' systems; double in three dimensions must be among them.
    std::vector<Kind> kinds;
    /// Where the default solves by iteration: the same solved to rounding.
    std::function<std::unique_ptr<AnyStepper>(const Scene&)> exact = {};
    /// The same through the matrices of a linearised scene (LinearOn in scene_on.hpp), if it has
    /// that.
    std::function<std::unique_ptr<AnyStepper>(const Scene&)> linear = {};
    double order = 0;       ///< of convergence; 0: not measured
    bool diverges = false;  ///< with a step that is far too large
};

/// Sections of a test case: counted steps are single steps; bad input is refused and nothing
/// touched; pins obey their velocity; momentum is kept; changes are taken up; nothing free is no
/// failure; traps stay silent; a linear scene moves as its matrices; the order; divergence is
/// reported.
void test_stepper(const StepperBattery& battery);

/// A loose net of 6 particles, 2 of them pinned, undamped, its springs well stretched: smooth
/// forces.
Scene smooth_scene(const Kind& kind);
/// Zero rest lengths, with gravity, pins and Rayleigh damping: forces are linear.
Scene linear_scene(const Kind& kind, bool damped);

/// max |a − b|.
double gap(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace taut_test
