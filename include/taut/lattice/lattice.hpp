// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "../network/spring_system.hpp"
#include "chain.hpp"

namespace taut {

/// A block of a cubic lattice, one corner at the origin.
struct LatticeOptions {
    std::array<Index, 3> particles{8, 8, 8};  ///< along x, y and z, ≥ 1 each
    double spacing = 0.1;                     ///< a, of neighbours, m
    double stiffness = 1000;                  ///< k between neighbours, N/m
    double diagonal = 1000;  ///< between particles on a diagonal of a face, N/m; 0: none
    double mass = 0.01;      ///< of each particle, kg
};

/// Particles on a cubic lattice, joined to their neighbours and across the faces of its cells:
/// 18 springs at an inner particle, 9 for each. Free, undamped, without gravity; particle
/// (z·ny + y)·nx + x.
///
/// Where both stiffnesses are k it is an isotropic solid of Young's modulus E = 5k/(2a) and
/// Poisson's ratio 1/4 (the Cauchy relations of central forces: C₁₁ = 3k/a, C₁₂ = C₄₄ = k/a), away
/// from its surface. Rest lengths are a and √2a, the same number for all springs of a kind.
/// @throws when a count is < 1, or a physical value is out of its range
template <class Scalar>
SpringSystem<Scalar, 3> lattice(const LatticeOptions& options = {}) {
    const Index nx = options.particles[0], ny = options.particles[1], nz = options.particles[2];
    if (nx < 1 || ny < 1 || nz < 1) {
        fail("lattice: ", nx, " by ", ny, " by ", nz, " particles; at least 1 of each are needed");
    }
    require_positive("lattice", "spacing", options.spacing);
    require_non_negative("lattice", "stiffness", options.stiffness);
    require_non_negative("lattice", "diagonal", options.diagonal);
    require_positive("lattice", "mass", options.mass);
    using Vector = Eigen::Matrix<Scalar, 3, 1>;
    SpringSystem<Scalar, 3> system;
    for (Index z = 0; z < nz; ++z) {
        for (Index y = 0; y < ny; ++y) {
            for (Index x = 0; x < nx; ++x) {
                const Eigen::Vector3d place(static_cast<double>(x), static_cast<double>(y),
                                            static_cast<double>(z));
                const Vector at = (options.spacing * place).template cast<Scalar>();
                system.add_particle(at, static_cast<Scalar>(options.mass));
            }
        }
    }
    const auto join = [&](Index dx, Index dy, Index dz) {
        const Index edges = dx * dx + dy * dy + dz * dz;
        const double k = edges == 1 ? options.stiffness : options.diagonal;
        const double L = options.spacing * std::sqrt(static_cast<double>(edges));
        if (k == 0) return;
        for (Index z = 0; z + dz < nz; ++z) {
            for (Index y = dy < 0 ? -dy : 0; y < ny && y + dy < ny; ++y) {
                for (Index x = dx < 0 ? -dx : 0; x < nx && x + dx < nx; ++x) {
                    const Index a = (z * ny + y) * nx + x;
                    system.add_spring(Spring<Scalar, Hookean>{a,
                                                              a + (dz * ny + dy) * nx + dx,
                                                              {static_cast<Scalar>(k)},
                                                              static_cast<Scalar>(L)});
                }
            }
        }
    };
    join(1, 0, 0);
    join(0, 1, 0);
    join(0, 0, 1);
    join(1, 1, 0);
    join(-1, 1, 0);
    join(1, 0, 1);
    join(-1, 0, 1);
    join(0, 1, 1);
    join(0, -1, 1);
    return system;
}

}  // namespace taut
