// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "../network/spring_system.hpp"

namespace taut {

/// Makes a system of the type Copy with the particles, pins, gravity and damping of another, and
/// the springs that `add` gives it. External forces stay behind.
/// @param add  add(copy, spring, s) for each spring s of the given system, in index order, a
///             `Spring` of its own law
template <class Copy, class System, class Add>
Copy with_springs(const System& system, Add&& add) {
    Copy copy;
    const auto start = system.initial_state();
    for (Index i = 0; i < system.size(); ++i) {
        copy.add_particle(start.x.col(i), system.mass(i));
        if (system.is_pinned(i)) copy.pin(i);
    }
    Index index = 0;
    system.visit_springs([&](auto spring) { add(copy, std::move(spring), index++); });
    copy.set_gravity(system.gravity());
    copy.set_rayleigh(system.rayleigh());
    return copy;
}

/// Makes a system like another, by with_springs, whose springs all follow `Law` with the parameters
/// that they have: with_law<TensionOnly>(cloth) does not push.
template <class Law, class System>
auto with_law(const System& system) {
    using Scalar = typename System::Scalar;
    using Copy = SpringSystem<Scalar, System::Dim, Law>;
    return with_springs<Copy>(system, [](Copy& copy, const auto& spring, Index) {
        copy.add_spring(Spring<Scalar, Law>{spring.a, spring.b, spring.parameters,
                                            spring.rest_length, spring.damping});
    });
}

}  // namespace taut
