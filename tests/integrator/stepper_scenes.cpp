// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/implicit_euler.hpp>

#include "stepper_scenes.hpp"

#include "../support/compiled_once.hpp"
#include "../support/direct_euler.hpp"
#include "../support/scene_on.hpp"

namespace taut_test {

namespace {

template <class System>
struct TightEuler : taut::ImplicitEuler<System> {
    explicit TightEuler(const System& system) : taut::ImplicitEuler<System>(system) {
        constexpr auto epsilon = std::numeric_limits<typename System::Scalar>::epsilon();
        this->configure([](auto& solver) { solver.setTolerance(16 * epsilon); });
    }
};

}  // namespace

std::unique_ptr<AnyStepper> through_matrices(const Scene& scene, taut::Method method) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Plain<float, 1>, Plain<float, 2>, Plain<double, 3>>(
        scene, [&](const auto& system) {
            using System = std::decay_t<decltype(system)>;
            using Linear = taut::LinearSystem<typename System::Scalar>;
            const auto make = [&](auto* of) {
                using Stepper = std::remove_pointer_t<decltype(of)>;
                made = std::make_unique<LinearOn<Stepper, System>>(system);
            };
            switch (method) {
                case taut::Method::explicit_euler:
                    return make(static_cast<taut::ExplicitEuler<Linear>*>(nullptr));
                case taut::Method::symplectic_euler:
                    return make(static_cast<taut::SymplecticEuler<Linear>*>(nullptr));
                case taut::Method::velocity_verlet:
                    return make(static_cast<taut::VelocityVerlet<Linear>*>(nullptr));
                default: return make(static_cast<taut::ImplicitEuler<Linear>*>(nullptr));
            }
        });
    return made;
}

std::unique_ptr<AnyStepper> exact_implicit_euler(const Scene& scene) {
    if (scene.kind().laws == Laws::any) return make_stepper<DirectEuler, AnyLaw<double, 3>>(scene);
    return make_stepper<TightEuler, Plain<float, 1>, Plain<float, 2>, Plain<float, 3>,
                        Plain<double, 1>, Plain<double, 2>, Plain<double, 3>, Strings<float, 2>,
                        Strings<float, 3>, Strings<double, 2>, Strings<double, 3>, Mixed<float, 2>,
                        Mixed<float, 3>, Mixed<double, 2>, Mixed<double, 3>>(scene);
}

}  // namespace taut_test
