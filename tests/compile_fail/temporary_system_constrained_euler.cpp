// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: deleted

#include <taut/constraints/constraints.hpp>
#include <taut/scene/cloth.hpp>

void step() { taut::ConstrainedEuler stepper(taut::hanging_cloth<double>({4, 4})); }
