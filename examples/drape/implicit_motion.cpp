// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The steppers that solve linear systems, compiled beside those that do not.

#include <taut/bdf2/bdf2.hpp>
#include <taut/newton/newton.hpp>
#include <taut/projective/projective.hpp>

#include "any_solver.hpp"
#include "stepping.hpp"

namespace drape {

Advance make_implicit_motion(const Options& options, const Scene& scene) {
    const auto choose = [&](auto& stepper) {
        stepper.configure(
            [&](AnySolver& solver) { solver.choose(options.solver, options.tolerance); });
    };
    if (options.integrator == "projective") {
        return plain_or_guarded<taut::ProjectiveDynamics<Cloth>>(options, scene, AsItIs());
    }
    if (options.integrator == "bdf2") {
        return plain_or_guarded<taut::Bdf2<Cloth, AnySolver>>(options, scene, choose);
    }
    if (options.integrator == "newton") {
        return plain_or_guarded<taut::NewtonEuler<Cloth, AnySolver>>(options, scene, choose);
    }
    return plain_or_guarded<taut::ImplicitEuler<Cloth, AnySolver>>(options, scene, choose);
}

}  // namespace drape
