// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <taut/network/spring_system.hpp>
#include <vector>

#include "../examples/common/garments.hpp"

namespace lab {

using Cloth = taut::SpringSystem<double, 3>;

/// What the figure wears; the example has 48 × 64 and 64 × 20 particles.
inline constexpr example::Garments garments{32, 44, 44, 14};
inline constexpr double garment_bend = 0.002;  // of bending springs, of the stiffness of threads

/// What the page plays with. Inside the lab z is up, whatever the file says.
struct Scene {
    Cloth cloth;
    std::vector<std::vector<taut::Index>> faces;  // corners are particles; of two: a line
    std::vector<double> stiffness;                // of each spring, in shares of the knob's N/m
    std::vector<double> mass;                     // of each particle, in shares of the knob's kg
    double edge = 0;                              // m, the mean of all edges
    bool worn = false;                            // by a figure that walks
    double knob = 1;                              // of stiffness, N/m
};

/// The one scene of this program.
Scene& scene();

/// Sets gravity by whether anything holds the scene: what floats would fall out of the picture.
void weigh();

/// Forgets what moved in the scene before it was changed.
void forget_motion();
/// Forgets what was found out about it.
void forget_limits();

}  // namespace lab
