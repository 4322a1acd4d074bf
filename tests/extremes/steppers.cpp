// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "steppers.hpp"

#include <taut/bdf2/bdf2.hpp>
#include <taut/projective/projective.hpp>

#include "../support/scene_on.hpp"

namespace taut_test {

std::unique_ptr<AnyStepper> bdf2(const Scene& scene) {
    return make_stepper<taut::Bdf2, Plain<float, 2>, Plain<double, 2>>(scene);
}
std::unique_ptr<AnyStepper> projective_dynamics(const Scene& scene) {
    return make_stepper<taut::ProjectiveDynamics, Plain<float, 2>, Plain<double, 2>>(scene);
}

}  // namespace taut_test
