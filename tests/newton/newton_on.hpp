// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/newton/newton.hpp>

#include "../support/held_once.hpp"
#include "../support/scene_on.hpp"
#include "newton_scenes.hpp"

namespace taut_test {

template <class System, class... Solver>
std::unique_ptr<AnyStepper> newton_on(const System& system, int iterations, double tolerance) {
    using Stepper = taut::NewtonEuler<System, Solver...>;
    typename Stepper::Options options;
    options.iterations = iterations;
    options.tolerance = tolerance;
    return std::make_unique<StepperOn<Stepper, System>>(system, options);
}

/// Compiled apart.
std::unique_ptr<AnyStepper> newton_in_2d(const Scene& scene, int iterations, double tolerance);

}  // namespace taut_test
