// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: has no limit that holds at every pose

#include <taut/integrator/explicit_euler.hpp>
#include <taut/guard/guard.hpp>

using System = taut::SpringSystem<double, 3>;
void guard(const System& system) { taut::Guarded<taut::ExplicitEuler<System>> guarded(system); }
