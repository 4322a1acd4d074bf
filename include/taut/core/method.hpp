// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

/// The integrators whose stability is analysed. Each stepper declares its own as `method`.
enum class Method { explicit_euler, symplectic_euler, velocity_verlet, implicit_euler };

/// The name as the programs and their JSON spell it.
constexpr const char* name(Method method) {
    switch (method) {
        case Method::explicit_euler: return "explicit_euler";
        case Method::symplectic_euler: return "symplectic_euler";
        case Method::velocity_verlet: return "velocity_verlet";
        case Method::implicit_euler: return "implicit_euler";
    }
    return "unknown";
}

}  // namespace taut
