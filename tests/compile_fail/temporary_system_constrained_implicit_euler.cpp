// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: deleted

#include <taut/integrator/constrained_implicit_euler.hpp>
#include <taut/scene/cloth.hpp>

void step() { taut::ConstrainedImplicitEuler stepper(taut::hanging_cloth<double>({4, 4})); }
