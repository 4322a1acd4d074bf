// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "bdf2_scenes.hpp"

#include <taut/bdf2/bdf2.hpp>
#include <taut/solver/conjugate_gradient.hpp>
#include <taut/solver/sparse_cholesky.hpp>

#include "../support/scene_on.hpp"

namespace taut_test {

namespace {

template <class System>
using Direct = taut::Bdf2<System, taut::SparseCholesky<typename System::Scalar>>;

}  // namespace

const std::vector<Kind> bdf2_kinds = {{true, 2}, {false, 3}};

std::unique_ptr<AnyStepper> direct_bdf2(const Scene& scene) {
    return make_stepper<Direct, Plain<float, 2>, Plain<double, 3>>(scene);
}

std::unique_ptr<AnyStepper> linear_bdf2(const Scene& scene) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Plain<float, 2>, Plain<double, 3>>(scene, [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        using Linear = taut::LinearSystem<typename System::Scalar>;
        made = std::make_unique<LinearOn<Direct<Linear>, System>>(system);
    });
    return made;
}

std::unique_ptr<AnyStepper> bdf2(const Scene& scene, double tolerance) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Plain<float, 2>, Plain<double, 3>>(scene, [&](const auto& system) {
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
