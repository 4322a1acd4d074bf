// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "options.hpp"
#include "step.hpp"

namespace drape {

inline void add_spring(Cloth& cloth, const Options& options, bool bends,
                       const taut::Spring<double, taut::Hookean>& spring) {
    const auto& [a, b, parameters, L, damping] = spring;
    if (options.law == "hookean") {
        cloth.add_spring(spring);
    } else if (options.law == "buckling" && bends) {
        const double k = parameters.stiffness;
        const double rigidity = options.bending.value_or(0.01 * k * L * L * L);
        cloth.add_spring<taut::Buckling>({a, b, {k, rigidity, k}, L, damping});
    } else if (options.law == "tension-only" || options.law == "buckling") {
        cloth.add_spring<taut::TensionOnly>({a, b, parameters, L, damping});
    } else {
        throw std::logic_error("--law: no springs of " + options.law);
    }
}

/// The scene with the springs of --law.
inline Cloth make_cloth(const Options& options, const example::Scene& scene) {
    Cloth cloth;
    const auto start = scene.system.initial_state();
    for (taut::Index i = 0; i < scene.system.size(); ++i) {
        cloth.add_particle(start.x.col(i), scene.system.mass(i));
        if (scene.system.is_pinned(i)) cloth.pin(i);
    }
    const auto& springs = scene.system.springs();
    for (taut::Index s = 0; s < springs.size(); ++s) {
        const auto at = static_cast<std::size_t>(s);
        add_spring(cloth, options, s >= scene.stretch_springs,
                   {springs.a[at], springs.b[at], springs.parameters[at], springs.rest_length[at],
                    springs.damping_of(at)});
    }
    cloth.set_gravity(scene.system.gravity());
    cloth.set_rayleigh(scene.system.rayleigh());
    return cloth;
}

/// The diagonal of the box round the particles, m.
inline double extent(const State& state) {
    return (state.x.rowwise().maxCoeff() - state.x.rowwise().minCoeff()).norm();
}

}  // namespace drape
