// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: deleted

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/scene/cloth.hpp>

const taut::SpringSystem<double, 3> make() { return taut::hanging_cloth<double>({4, 4}); }

void step() { taut::SymplecticEuler stepper(make()); }
