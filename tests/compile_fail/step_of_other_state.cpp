// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: a step takes the system's State, or a StateView

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/network/spring_system.hpp>

void step(const taut::SpringSystem<double, 3>& system, taut::State<float, 3>& state) {
    taut::SymplecticEuler stepper(system);
    (void)stepper.step(state, 1e-3);
}
