// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/network/spring_system.hpp>

#include "laws.hpp"

namespace taut_test {

/// Springs between random particles, with rest lengths of their own: in most poses some are
/// compressed and some stretched. Duplicates occur.
template <class System>
System random_like(Random& random, const RandomOptions& options = {}) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    System system;
    for (Index i = 0; i < options.particles; ++i) {
        const auto place = random.vector<Scalar, Dim>(-1, 1);
        system.add_particle(place, static_cast<Scalar>(random.uniform(0.5, 2)));
    }
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (Index s = 0; s < options.springs; ++s) {
            const Index a = random.below(options.particles);
            const Index b = (a + 1 + random.below(options.particles - 1)) % options.particles;
            const auto parameters = draw_parameters<Scalar>(random, Law{});
            const auto rest_length = static_cast<Scalar>(random.uniform(0.2, 1.4));
            const auto damping = static_cast<Scalar>(random.uniform(0.1, 1));
            const bool damped = options.dampers && s % 2 == 1;
            system.add_spring(taut::Spring<Scalar, Law>{a, b, parameters, rest_length,
                                                        damped ? damping : Scalar(0)});
        }
    });
    for (Index i = 0; i < options.pinned; ++i) system.pin(i);
    if (options.gravity) system.set_gravity(random.vector<Scalar, Dim>(-10, 10));
    if (options.rayleigh) system.set_rayleigh({0.25, 0.0078125});
    return system;
}

template <class Scalar, int Dim, class... Laws>
auto random_system(Random& random, const RandomOptions& options = {}) {
    return random_like<taut::SpringSystem<Scalar, Dim, Laws...>>(random, options);
}

/// Springs of no rest length: K is constant, and so is D of drag and Rayleigh damping. Two pins.
template <class Scalar, int Dim>
auto zero_length_system(Random& random) {
    taut::SpringSystem<Scalar, Dim> system;
    constexpr Index particles = 9;
    for (Index i = 0; i < particles; ++i) {
        system.add_particle(random.vector<Scalar, Dim>(-1, 1),
                            static_cast<Scalar>(log_uniform(random, 0.1, 10)));
    }
    for (Index s = 0; s < 18; ++s) {
        const Index a = random.below(particles);
        const Index b = (a + 1 + random.below(particles - 1)) % particles;
        const auto k = static_cast<Scalar>(log_uniform(random, 1, 1000));
        system.add_spring(taut::Spring<Scalar, taut::Hookean>{a, b, {k}, Scalar(0)});
    }
    system.pin(0);
    system.pin(1);
    system.set_gravity(random.vector<Scalar, Dim>(-10, 10));
    return system;
}

/// A crumpled pose: every particle anywhere in a cube, with any velocity.
template <class System>
typename System::State random_state(Random& random, const System& system) {
    auto state = system.initial_state();
    state.x = random.points<typename System::Scalar, System::Dim>(system.size(), -1, 1);
    state.v = random.points<typename System::Scalar, System::Dim>(system.size(), -1, 1);
    return state;
}

template <class Scalar, int Dim>
bool same_bits(const taut::State<Scalar, Dim>& a, const taut::State<Scalar, Dim>& b) {
    return a.x.cols() == b.x.cols() && a.v.cols() == b.v.cols() && a.x == b.x && a.v == b.v &&
           a.time == b.time;
}

}  // namespace taut_test
