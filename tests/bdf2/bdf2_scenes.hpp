// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/scene.hpp"

namespace taut_test {

/// Scenes that there is a Bdf2 for.
extern const std::vector<Kind> bdf2_kinds;
/// And for that with a direct solver.
extern const std::vector<Kind> direct_bdf2_kinds;

/// With a direct solver: exact to rounding.
std::unique_ptr<AnyStepper> direct_bdf2(const Scene& scene);
/// The same on the scene's matrices; of bdf2_kinds.
std::unique_ptr<AnyStepper> linear_bdf2(const Scene& scene);
/// By conjugate gradients, up to `tolerance` unless it is 0; of bdf2_kinds.
std::unique_ptr<AnyStepper> bdf2(const Scene& scene, double tolerance = 0);

}  // namespace taut_test
