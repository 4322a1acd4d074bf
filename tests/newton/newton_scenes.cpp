// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "newton_scenes.hpp"

#include <taut/integrator/implicit_euler.hpp>
#include <taut/solver/conjugate_gradient.hpp>

#include "newton_on.hpp"

namespace taut_test {

std::unique_ptr<AnyStepper> newton(const Scene& scene, int iterations, double tolerance) {
    if (scene.dim() == 2) return newton_in_2d(scene, iterations, tolerance);
    std::unique_ptr<AnyStepper> made;
    visit_system<Plain<double, 1>, Plain<double, 3>>(
        scene, [&](const auto& system) { made = newton_on(system, iterations, tolerance); });
    return made;
}

std::unique_ptr<AnyStepper> newton_by_gradients(const Scene& scene) {
    using System = Plain<double, 3>;
    std::unique_ptr<AnyStepper> made;
    visit_system<System>(scene, [&](const System& system) {
        made = newton_on<System, taut::ConjugateGradient<double, 3>>(system, 60, 1e-11);
    });
    return made;
}

}  // namespace taut_test
