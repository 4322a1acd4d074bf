// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "bdf2_scenes.hpp"

#include <taut/solver/conjugate_gradient.hpp>

#include "bdf2_on.hpp"

namespace taut_test {

const std::vector<Kind> bdf2_kinds = {{true, 1}, {true, 2}, {false, 3}};
const std::vector<Kind> direct_bdf2_kinds = {
    {true, 1}, {true, 2}, {false, 1}, {false, 3}, {false, 3, Laws::any}};

std::unique_ptr<AnyStepper> direct_bdf2(const Scene& scene) {
    if (scene.kind().laws == Laws::any) return direct_bdf2_of_laws(scene);
    return make_stepper<DirectBdf2, Plain<float, 1>, Plain<float, 2>, Plain<double, 1>,
                        Plain<double, 3>>(scene);
}

std::unique_ptr<AnyStepper> linear_bdf2(const Scene& scene) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Plain<float, 1>, Plain<float, 2>, Plain<double, 3>>(
        scene, [&](const auto& system) {
            using System = std::decay_t<decltype(system)>;
            using Linear = taut::LinearSystem<typename System::Scalar>;
            made = std::make_unique<LinearOn<DirectBdf2<Linear>, System>>(system);
        });
    return made;
}

std::unique_ptr<AnyStepper> bdf2(const Scene& scene, double tolerance) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Plain<float, 1>, Plain<float, 2>, Plain<double, 3>>(
        scene, [&](const auto& system) {
            using System = std::decay_t<decltype(system)>;
            using Scalar = typename System::Scalar;
            using Stepper = taut::Bdf2<System>;
            static_assert(Stepper::order == 2);
            auto stepper = std::make_unique<StepperOn<Stepper, System>>(system);
            if (tolerance > 0) {
                stepper->stepper().configure(
                    [&](auto& solver) { solver.setTolerance(static_cast<Scalar>(tolerance)); });
            }
            made = std::move(stepper);
        });
    return made;
}

}  // namespace taut_test
