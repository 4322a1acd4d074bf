// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/scene.hpp"

namespace taut_test {

/// Scenes that through_matrices() takes.
inline const std::vector<Kind> matrix_kinds = {{true, 1}, {true, 2}, {false, 3}};
/// Explicit Euler, symplectic Euler, velocity Verlet or implicit Euler through the matrices of a
/// scene linearised at its initial state.
std::unique_ptr<AnyStepper> through_matrices(const Scene& scene, taut::Method method);

/// Implicit Euler solved to rounding: of Laws::any by a direct solver, with double in three
/// dimensions; of all others by conjugate gradients.
std::unique_ptr<AnyStepper> exact_implicit_euler(const Scene& scene);

}  // namespace taut_test
