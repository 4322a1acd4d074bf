// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "newton_scenes.hpp"

#include <taut/newton/newton.hpp>
#include <taut/solver/conjugate_gradient.hpp>

#include "../support/scene_on.hpp"

namespace taut_test {

namespace {

using System = Plain<double, 3>;

template <class... Solver>
std::unique_ptr<AnyStepper> make(const Scene& scene, int iterations, double tolerance) {
    using Stepper = taut::NewtonEuler<System, Solver...>;
    typename Stepper::Options options;
    options.iterations = iterations;
    options.tolerance = tolerance;
    std::unique_ptr<AnyStepper> made;
    visit_system<System>(scene, [&](const System& system) {
        made = std::make_unique<StepperOn<Stepper, System>>(system, options);
    });
    return made;
}

}  // namespace

std::unique_ptr<AnyStepper> newton(const Scene& scene, int iterations, double tolerance) {
    return make(scene, iterations, tolerance);
}
std::unique_ptr<AnyStepper> newton_by_gradients(const Scene& scene) {
    return make<taut::ConjugateGradient<double, 3>>(scene, 60, 1e-11);
}

}  // namespace taut_test
