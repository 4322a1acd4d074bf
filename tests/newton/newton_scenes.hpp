// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/scene.hpp"

namespace taut_test {

/// Of Hookean springs of double in three dimensions.
std::unique_ptr<AnyStepper> newton(const Scene& scene, int iterations = 60,
                                   double tolerance = 1e-11);
/// With ConjugateGradient for its solver.
std::unique_ptr<AnyStepper> newton_by_gradients(const Scene& scene);

}  // namespace taut_test
