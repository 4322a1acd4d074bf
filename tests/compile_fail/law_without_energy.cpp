// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Law: needs `static Scalar energy(
// ERRORS: 1

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

class NoEnergy : public taut::Hookean {
    using Hookean::energy;  // private: as good as absent
};

void use(taut::SpringSystem<double, 3, NoEnergy>& system) {
    system.add_spring<NoEnergy>(0, 1, {10});
    auto state = system.initial_state();
    system.energy(state);
    taut::linearize(system, state);
    taut::SymplecticEuler stepper(system);
    if (!stepper.step(state, 0.01)) return;
}
