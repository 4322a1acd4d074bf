// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: deleted

#include <taut/newton/newton.hpp>
#include <taut/scene/cloth.hpp>

void step() { taut::NewtonEuler stepper(taut::hanging_cloth<double>({4, 4})); }
