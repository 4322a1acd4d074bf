// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The steppers that solve linear systems, compiled beside those that do not.

#include <memory>
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/newton/newton.hpp>
#include <taut/projective/projective.hpp>

#include "any_solver.hpp"
#include "step.hpp"

namespace drape {

Step implicit_step(const Cloth& cloth, const std::string& integrator, const std::string& solver,
                   std::optional<double> tolerance) {
    const auto by = [](auto stepper) -> Step {
        return [stepper](State& state, double h, taut::Index count) {
            return stepper->step(state, h, count);
        };
    };
    const auto choose = [&](auto stepper) {
        stepper->configure([&](AnySolver& any) { any.choose(solver, tolerance); });
        return by(stepper);
    };
    if (integrator == "projective") {
        return by(std::make_shared<taut::ProjectiveDynamics<Cloth>>(cloth));
    }
    if (integrator == "bdf2") return choose(std::make_shared<taut::Bdf2<Cloth, AnySolver>>(cloth));
    if (integrator == "newton") {
        return choose(std::make_shared<taut::NewtonEuler<Cloth, AnySolver>>(cloth));
    }
    return choose(std::make_shared<taut::ImplicitEuler<Cloth, AnySolver>>(cloth));
}

}  // namespace drape
