// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "cloth_scene.hpp"

namespace taut_test {

Scene cloth_scene(const Kind& kind, const taut::ClothOptions& options, LawOf law) {
    const auto cloth = taut::hanging_cloth<double>(options);
    const auto state = cloth.initial_state();
    Scene scene(kind);
    for (Index i = 0; i < cloth.size(); ++i) {
        scene.add_particle(state.x.col(i), cloth.mass(i));
        if (cloth.is_pinned(i)) scene.pin(i);
    }
    for (const auto spring : cloth.springs()) {
        scene.add_spring({spring.a, spring.b, spring.parameters.stiffness, spring.rest_length,
                          spring.damping, law});
    }
    scene.set_gravity(cloth.gravity());
    scene.set_rayleigh(options.rayleigh.mass_proportional, options.rayleigh.stiffness_proportional);
    return scene;
}

}  // namespace taut_test
