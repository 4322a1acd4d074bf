// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/integrator/symplectic_euler.hpp>

#include "../plain_loop.hpp"

namespace bench {

using Cloth = taut::SpringSystem<double, 3>;

/// The same steps of a scene that somebody else has built, each alone in an object file: lean_step
/// counts their instructions.
void plain_steps(PlainLoop<double>& loop, double h, int count);
taut::Report taut_steps(taut::SymplecticEuler<Cloth>& stepper, Cloth::State& state, double h,
                        int count);

}  // namespace bench
