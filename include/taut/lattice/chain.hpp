// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "../network/spring_system.hpp"

namespace taut {

/// How the ends of a chain are held. A fixed end is a spring to a pinned particle.
enum class ChainEnds { fixed_fixed, fixed_free, free_free, ring };

/// What chain() builds.
struct ChainOptions {
    Index masses = 8;  ///< free particles, ≥ 1 (≥ 2 in free_free, ≥ 3 in a ring)
    ChainEnds ends = ChainEnds::fixed_fixed;
    double mass = 1;       ///< of each particle, kg
    double stiffness = 1;  ///< of each spring, N/m
    double spacing = 1;    ///< distance of neighbours, m
};

/// Equal masses and springs in a row along the first axis, or in a circle (for Dim = 1 too a ring
/// is closed by a spring from the last to the first). Free particles come first, pinned ones last.
/// The eigenvalues of M⁻¹K along the chain have closed forms (docs/theory/modes.md).
template <class Scalar, int Dim = 1>
SpringSystem<Scalar, Dim> chain(const ChainOptions& options = {}) {
    const bool ring = options.ends == ChainEnds::ring;
    const Index n = options.masses;
    const Index least = ring ? 3 : options.ends == ChainEnds::free_free ? 2 : 1;
    if (n < least) fail("chain: masses is ", n, "; these ends need at least ", least);

    require_positive("chain", "mass", options.mass);
    require_non_negative("chain", "stiffness", options.stiffness);
    require_non_negative("chain", "spacing", options.spacing);
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    const auto place = [&](Index i) {
        Vector x = Vector::Zero();
        if constexpr (Dim >= 2) {
            if (ring) {
                const double sector = 2 * static_cast<double>(EIGEN_PI) / static_cast<double>(n);
                const double angle = sector * static_cast<double>(i);
                const double radius = options.spacing / (2 * std::sin(sector / 2));
                x[0] = static_cast<Scalar>(radius * std::cos(angle));
                x[1] = static_cast<Scalar>(radius * std::sin(angle));
                return x;
            }
        }
        x[0] = static_cast<Scalar>(options.spacing * static_cast<double>(i));
        return x;
    };
    SpringSystem<Scalar, Dim> system;
    const auto add_particle = [&](Index i) {
        return system.add_particle(place(i), static_cast<Scalar>(options.mass));
    };
    const auto join = [&](Index a, Index b) {
        system.add_spring(a, b, static_cast<Scalar>(options.stiffness));
    };
    for (Index i = 0; i < n; ++i) add_particle(i);
    for (Index i = 0; i + 1 < n; ++i) join(i, i + 1);
    if (ring) join(n - 1, 0);
    if (options.ends == ChainEnds::fixed_fixed || options.ends == ChainEnds::fixed_free) {
        const Index wall = add_particle(-1);
        join(wall, 0);
        system.pin(wall);
    }
    if (options.ends == ChainEnds::fixed_fixed) {
        const Index wall = add_particle(n);
        join(n - 1, wall);
        system.pin(wall);
    }
    return system;
}

}  // namespace taut
