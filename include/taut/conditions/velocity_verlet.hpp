// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "symplectic_euler.hpp"

namespace taut::method {

/// The descriptor of velocity Verlet. With damping taken at the half step it is symplectic Euler in
/// (x, v at the half step), so it shares that one's multipliers and limits.
struct VelocityVerlet : SymplecticEuler {
    static constexpr Method method = Method::velocity_verlet;
    static constexpr const char* name = "velocity_verlet";
    static constexpr int order = 2;  ///< undamped; 1 with damping
};

}  // namespace taut::method
