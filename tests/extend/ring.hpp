// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/network/spring_system.hpp>

namespace taut_test {

struct RingOptions {
    Index particles = 12;     ///< ≥ 3
    double radius = 1;        ///< m, > 0
    double mass = 0.1;        ///< of each particle, kg, > 0
    double stiffness = 1000;  ///< of each spring, N/m, ≥ 0
};

/// Particles on a circle, each joined to the next, at rest. At every pose k_max is at most
/// 4·stiffness/mass, which the graph of an even number of them attains.
/// @throws naming the option that is out of its range
template <class Scalar>
taut::SpringSystem<Scalar, 2> ring(const RingOptions& options = {}) {
    if (options.particles < 3)
        taut::fail("ring: particles is ", options.particles, "; it must be >= 3");
    taut::require_positive("ring", "radius", options.radius);
    taut::require_positive("ring", "mass", options.mass);
    taut::require_non_negative("ring", "stiffness", options.stiffness);
    taut::SpringSystem<Scalar, 2> system;
    for (Index i = 0; i < options.particles; ++i) {
        const double angle = 2 * std::acos(-1.0) * double(i) / double(options.particles);
        system.add_particle({static_cast<Scalar>(options.radius * std::cos(angle)),
                             static_cast<Scalar>(options.radius * std::sin(angle))},
                            static_cast<Scalar>(options.mass));
    }
    for (Index i = 0; i < options.particles; ++i) {
        system.add_spring(i, (i + 1) % options.particles, static_cast<Scalar>(options.stiffness));
    }
    return system;
}

}  // namespace taut_test
