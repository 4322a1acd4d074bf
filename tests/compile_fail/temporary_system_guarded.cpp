// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: deleted

#include <taut/guard/guard.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/scene/cloth.hpp>

using Cloth = taut::SpringSystem<double, 3>;
void step() {
    taut::Guarded<taut::SymplecticEuler<Cloth>> stepper(taut::hanging_cloth<double>({4, 4}));
}
