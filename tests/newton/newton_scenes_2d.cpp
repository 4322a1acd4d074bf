// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "newton_on.hpp"

namespace taut_test {

std::unique_ptr<AnyStepper> newton_in_2d(const Scene& scene, int iterations, double tolerance) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Plain<float, 2>, AnyLaw<double, 2>>(
        scene, [&](const auto& system) { made = newton_on(system, iterations, tolerance); });
    return made;
}

}  // namespace taut_test
