// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <taut/network/spring_system.hpp>
#include <taut/proof/stability.hpp>

// How a scene is kicked along its limiting mode, to be stepped just below and just above its limit.

namespace example {

inline constexpr double below_limit = 0.99;  // of the certified step
inline constexpr double above_limit = 1.01;  // of the refuted step

struct Kick {
    taut::Points<double, 3> shape;  // m, to be added to the pose
    double size = 0;                // m, of the particle that moves most
    double speed = 0;               // 1/s, the velocity over the displacement
    taut::Index steps = 0;          // that show what comes of it
};

/// @param edge  m, an edge's length: the kick is small beside it
/// @param mode  the limiting mode of symplectic Euler
inline Kick kick_along(const taut::SpringSystem<double, 3>& system, double edge,
                       const taut::StepLimit<double>& limit, const taut::Mode& mode) {
    constexpr double kick_of_edge = 1e-4;
    const double h = above_limit * limit.refuted;
    const auto mu = taut::multipliers(taut::Method::symplectic_euler, mode.k, mode.d, h);
    const auto larger = std::abs(mu[0]) >= std::abs(mu[1]) ? mu[0] : mu[1];
    // As many steps as it takes the kick to grow to an edge's length, three times over: the rest
    // shows what comes of it.
    const double wanted = -3 * std::log(kick_of_edge) / std::log(std::abs(larger));
    Kick kick;
    kick.steps = wanted > 10 && wanted < 600 ? std::lround(wanted) : 600;
    kick.shape = taut::Points<double, 3>::Zero(3, system.size());
    for (taut::Index i = 0, free = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) kick.shape.col(i) = mode.shape.segment<3>(3 * free++);
    }
    kick.size = kick_of_edge * edge;
    kick.shape *= kick.size / kick.shape.colwise().norm().maxCoeff();
    kick.speed = ((larger - 1.0) / (h * larger)).real();  // x⁺ = μx, so that it grows at once
    return kick;
}

}  // namespace example
