// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/scene.hpp"

namespace taut_test {

/// Log-uniform masses 1e-9 … 1e9 and stiffnesses 1e-12 … 1e15 in one scene.
inline Scene extreme_scene(Random& random, const Kind& kind, bool damped) {
    Scene scene(kind);
    const Index n = 3 + random.below(5);
    for (Index i = 0; i < n; ++i) {
        const auto place = random_vector(random, kind.dim, -1, 1);
        scene.add_particle(place, log_uniform(random, 1e-9, 1e9));
    }
    for (Index s = 0; s < 3 * n; ++s) {
        AnySpring spring;
        spring.a = random.below(n);
        spring.b = (spring.a + 1 + random.below(n - 1)) % n;
        if (damped && random.below(2) == 0) spring.damping = log_uniform(random, 1e-12, 1e12);
        spring.stiffness = log_uniform(random, 1e-12, 1e15);
        spring.rest_length = random.uniform(0, 1.5);
        scene.add_spring(spring);
    }
    if (random.below(2) == 0) scene.pin(random.below(n));
    if (damped && random.below(2) == 0) {
        const double d0 = log_uniform(random, 1e-9, 1e9);
        scene.set_rayleigh(d0, log_uniform(random, 1e-12, 1e3));
    }
    return scene;
}

}  // namespace taut_test
