// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

/// The integrators whose cost and error are compared: those of Method, and BDF2, whose step has
/// four multipliers to a mode in place of two.
enum class Scheme { explicit_euler, symplectic_euler, velocity_verlet, implicit_euler, bdf2 };

/// The name as tables and sentences spell it.
constexpr const char* name(Scheme scheme) {
    switch (scheme) {
        case Scheme::explicit_euler: return "explicit_euler";
        case Scheme::symplectic_euler: return "symplectic_euler";
        case Scheme::velocity_verlet: return "velocity_verlet";
        case Scheme::implicit_euler: return "implicit_euler";
        case Scheme::bdf2: return "bdf2";
    }
    return "unknown";
}

/// Whether a step solves a linear system.
constexpr bool is_implicit(Scheme scheme) {
    return scheme == Scheme::implicit_euler || scheme == Scheme::bdf2;
}

}  // namespace taut
