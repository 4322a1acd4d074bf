// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/stability_scenes.hpp"

namespace taut_test {

/// What wild_scene makes, as a system.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> wild_system(Random& random, const WildOptions& options = {}) {
    const Scene scene =
        wild_scene(random, {std::is_same_v<Scalar, float>, Dim, Laws::hookean}, options);
    taut::SpringSystem<Scalar, Dim> system;
    const auto x = scene.initial_state().x.template cast<Scalar>().eval();
    for (Index i = 0; i < scene.size(); ++i) {
        system.add_particle(x.col(i), static_cast<Scalar>(scene.mass(i)));
        if (scene.is_pinned(i)) system.pin(i);
    }
    for (const AnySpring& s : scene.springs()) {
        system.add_spring(taut::Spring<Scalar, taut::Hookean>{s.a,
                                                              s.b,
                                                              {static_cast<Scalar>(s.stiffness)},
                                                              static_cast<Scalar>(s.rest_length),
                                                              static_cast<Scalar>(s.damping)});
    }
    system.set_rayleigh({scene.mass_proportional(), scene.stiffness_proportional()});
    return system;
}

}  // namespace taut_test
