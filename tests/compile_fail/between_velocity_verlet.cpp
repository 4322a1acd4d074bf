// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::step_between: a SymplecticEuler or an EnergyStableEuler
// ERRORS: 1

#include <taut/between/between.hpp>
#include <taut/integrator/velocity_verlet.hpp>

using System = taut::SpringSystem<float, 3>;

void step(taut::VelocityVerlet<System>& stepper, taut::State<float, 3>& state) {
    (void)taut::step_between(stepper, state, 0.001f, 10, [](auto&) {});
}
