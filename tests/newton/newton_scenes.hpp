// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/integrator/implicit_euler.hpp>

#include "../support/scene.hpp"

namespace taut_test {

/// Of these kinds: Hookean springs of double in one and three dimensions and of float in two, all
/// laws of double in two.
constexpr Kind newton_kinds[] = {
    {false, 1}, {true, 2}, {false, 2, Laws::any}, {false, 3, Laws::hookean}};
std::unique_ptr<AnyStepper> newton(const Scene& scene, int iterations = 60,
                                   double tolerance = 1e-11);
/// With ConjugateGradient for its solver; of the last kind.
std::unique_ptr<AnyStepper> newton_by_gradients(const Scene& scene);

}  // namespace taut_test
