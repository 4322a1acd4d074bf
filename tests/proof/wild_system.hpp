// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/scene/with_law.hpp>

#include "../support/scene_on.hpp"
#include "../support/proof_scenes.hpp"

// The scenes of the stability tests as systems, for tests that name one.

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

/// visit(text, system, state) for the scenes of stability_cases of these dimensions.
template <class Scalar, int... Dims, class Visit>
void for_each_scene(Visit&& visit) {
    for (const auto& c : stability_cases(std::is_same_v<Scalar, float>, false)) {
        if (((c.scene.dim() != Dims) && ...)) continue;
        visit_system<Plain<Scalar, Dims>...>(c.scene, [&](const auto& system) {
            using State = typename std::decay_t<decltype(system)>::State;
            visit(c.text, system, from_any<State>(c.state));
        });
    }
}

/// visit(text, damped system); `omega` is the scale of its frequencies.
template <class System, class Visit>
void for_each_damping(const System& system, double omega, Visit&& visit) {
    for (const auto& [text, dampers, d0, alpha] : dampings) {
        auto damped = taut::with_springs<System>(system, [&](System& copy, auto spring, Index) {
            spring.damping = static_cast<typename System::Scalar>(
                dampers / omega * static_cast<double>(spring.parameters.stiffness));
            copy.add_spring(spring);
        });
        damped.set_rayleigh({d0 * omega, alpha / omega});
        visit(std::string(text), damped);
    }
}

/// As that of a Scene.
template <class System>
typename System::State deformed(const System& system, double factor, double noise,
                                std::uint32_t seed) {
    using Scalar = typename System::Scalar;
    Random random(seed);
    auto state = system.initial_state();
    state.x *= static_cast<Scalar>(factor);
    state.x += random.points<Scalar, System::Dim>(system.size(), -noise, noise);
    return state;
}

}  // namespace taut_test
