// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/imex/imex.hpp>

#include "../support/scene_on.hpp"
#include "imex_scenes.hpp"

namespace taut_test {

template <class System>
class ImexOn : public StepperOn<taut::ImexEuler<System>, System, AnyImex> {
public:
    using StepperOn<taut::ImexEuler<System>, System, AnyImex>::StepperOn;

    taut::StepLimit<double> limit() const override { return to_any(this->stepper_.limit()); }
    double share(Index s) const override { return this->stepper_.share(s); }
    Index implicit_springs() const override { return this->stepper_.implicit_springs(); }
    Index touched() const override { return this->stepper_.touched(); }
    std::int64_t factorizations() const override { return this->stepper_.factorizations(); }
    double added_kinetic(const AnyState& state) const override {
        return this->stepper_.added_kinetic(from_any<typename System::State>(state));
    }
};

template <class... Systems>
std::unique_ptr<AnyImex> make_imex(const Scene& scene, const taut::ImexOptions& options) {
    std::unique_ptr<AnyImex> made;
    visit_system<Systems...>(scene, [&](const auto& system) {
        made = std::make_unique<ImexOn<std::decay_t<decltype(system)>>>(system, options);
    });
    return made;
}

/// Compiled apart.
std::unique_ptr<AnyImex> imex_of_laws(const Scene& scene, const taut::ImexOptions& options);
std::unique_ptr<AnyImex> imex_of_laws_in_3d(const Scene& scene, const taut::ImexOptions& options);

}  // namespace taut_test
