// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/model/spring_system.hpp>

#include "../support/stability_scenes.hpp"

namespace taut_test {

struct WildOptions {
    Index most_particles = 6;
    double decades = 3;   ///< masses and stiffnesses spread over twice as many
    bool damping = true;  ///< dampers and Rayleigh, at random
    bool pins = true;
};

inline double over_decades(Random& random, double decades) {
    return log_uniform(random, std::pow(10.0, -decades), std::pow(10.0, decades));
}

/// A small random graph of springs whose masses and stiffnesses lie orders of magnitude apart, some
/// springs compressed, some without length, with random pins, dampers and Rayleigh damping. Never
/// without a free particle.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> wild_system(Random& random, const WildOptions& options = {}) {
    taut::SpringSystem<Scalar, Dim> system;
    const Index n = 2 + random.below(options.most_particles - 1);
    for (Index i = 0; i < n; ++i) {
        auto place = random.vector<Scalar, Dim>(-1, 1);
        if (i > 0 && random.below(12) == 0) place = system.initial_state().x.col(i - 1);
        system.add_particle(place, static_cast<Scalar>(over_decades(random, options.decades)));
    }
    const bool dampers = options.damping && random.below(2) == 0;
    const Index springs = 1 + random.below(3 * n);
    for (Index s = 0; s < springs; ++s) {
        const Index a = random.below(n);
        const Index b = (a + 1 + random.below(n - 1)) % n;
        const double k = over_decades(random, options.decades);
        const double c =
            dampers && random.below(2) == 0 ? over_decades(random, options.decades) : 0;
        const double rest = random.below(5) == 0 ? 0 : random.uniform(0, 2);
        system.add_spring(taut::Spring<Scalar, taut::Hookean>{
            a, b, {static_cast<Scalar>(k)}, static_cast<Scalar>(rest), static_cast<Scalar>(c)});
    }
    if (options.damping && random.below(2) == 0) {
        system.set_rayleigh({random.below(3) == 0 ? 0 : over_decades(random, options.decades),
                             random.below(3) == 0 ? 0 : over_decades(random, options.decades)});
    }
    for (Index i = 0; options.pins && i + 1 < n; ++i) {
        if (random.below(5) == 0) system.pin(i);
    }
    return system;
}

/// Weights of M, K and D of either sign, some of them zero.
inline taut::Combination wild_combination(Random& random) {
    const auto weight = [&] {
        return random.below(4) == 0 ? 0 : (random.below(2) == 0 ? 1 : -1) * over_decades(random, 2);
    };
    namespace matrices = taut::matrices;
    const double mass = weight();
    const double stiffness = weight();
    const double damping = weight();
    return mass * matrices::M + damping * matrices::D +
           stiffness * (random.below(2) == 0 ? matrices::K_plus : matrices::K);
}

/// The sum in long double.
inline RealMatrix exact_sum(const Exact& e, const taut::Combination& c) {
    RealMatrix S = static_cast<Real>(c.stiffness()) * e.K +
                   static_cast<Real>(c.projected()) * e.K_plus +
                   static_cast<Real>(c.damping()) * e.D;
    S.diagonal() += static_cast<Real>(c.mass()) * e.mass;
    return S;
}

/// Eigenvalues of M⁻¹S, ascending.
inline RealVector exact_eigenvalues(const Exact& e, const taut::Combination& c) {
    const bool project = c.projected() != 0;
    return eigenvalues(e.scaled(static_cast<Real>(c.mass()),
                                static_cast<Real>(project ? c.projected() : c.stiffness()),
                                static_cast<Real>(c.damping()), project));
}

inline Eigen::VectorXd random_vector(Random& random, Index n) {
    Eigen::VectorXd u(n);
    for (Index i = 0; i < n; ++i) u[i] = random.uniform(-1, 1);
    return u;
}

}  // namespace taut_test
