// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: deleted

#include <taut/integrator/velocity_verlet.hpp>
#include <taut/scene/cloth.hpp>

void step() { taut::VelocityVerlet stepper(taut::hanging_cloth<double>({4, 4})); }
