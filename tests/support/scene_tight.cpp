// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/proof/sharp_limit.hpp>

#include "compiled_once.hpp"
#include "scene_on.hpp"

namespace taut_test {

taut::StepLimit<double> Scene::any_pose_limit(double tightness) const {
    if (tightness == 0) return base_->any_pose_limit();
    taut::StepLimit<double> limit;
    visit_any_system(*this, [&](const auto& system) {
        limit = to_any(taut::any_pose_limit(system, tightness));
    });
    return limit;
}

taut::StepLimit<double> Scene::energy_limit(double tightness) const {
    if (tightness == 0) return base_->energy_limit();
    taut::StepLimit<double> limit;
    visit_any_system(
        *this, [&](const auto& system) { limit = to_any(taut::energy_limit(system, tightness)); });
    return limit;
}

taut::StepLimit<double> Scene::sharp_any_pose_limit() const {
    taut::StepLimit<double> limit;
    visit_any_system(
        *this, [&](const auto& system) { limit = to_any(taut::sharp_any_pose_limit(system)); });
    return limit;
}

taut::StepLimit<double> Scene::sharp_energy_limit() const {
    taut::StepLimit<double> limit;
    visit_any_system(*this,
                     [&](const auto& system) { limit = to_any(taut::sharp_energy_limit(system)); });
    return limit;
}

}  // namespace taut_test
