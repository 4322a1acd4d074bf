// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/model/spring_system.hpp>

#include "../stability/wild_system.hpp"

namespace taut_test {

/// Log-uniform masses 1e-9 … 1e9 and stiffnesses 1e-12 … 1e15 in one system.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> extreme_system(Random& random, bool damped) {
    const auto drawn = [&](double low, double high) {
        return static_cast<Scalar>(log_uniform(random, low, high));
    };
    taut::SpringSystem<Scalar, Dim> system;
    const Index n = 3 + random.below(5);
    for (Index i = 0; i < n; ++i)
        system.add_particle(random.vector<Scalar, Dim>(-1, 1), drawn(1e-9, 1e9));
    for (Index s = 0; s < 3 * n; ++s) {
        const Index a = random.below(n);
        const Index b = (a + 1 + random.below(n - 1)) % n;
        const Scalar damping = damped && random.below(2) == 0 ? drawn(1e-12, 1e12) : 0;
        system.add_spring(taut::Spring<Scalar, taut::Hookean>{
            a, b, {drawn(1e-12, 1e15)}, static_cast<Scalar>(random.uniform(0, 1.5)), damping});
    }
    if (random.below(2) == 0) system.pin(random.below(n));
    if (damped && random.below(2) == 0)
        system.set_rayleigh({log_uniform(random, 1e-9, 1e9), log_uniform(random, 1e-12, 1e3)});
    return system;
}

}  // namespace taut_test
