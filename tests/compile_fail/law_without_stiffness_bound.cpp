// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Law: needs `static Scalar stiffness_bound(
// ERRORS: 1

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

class NoBound : public taut::Hookean {
    using Hookean::stiffness_bound;  // private: as good as absent
};

void use(taut::SpringSystem<double, 3, NoBound>& system) {
    system.add_spring<NoBound>(0, 1, {10});
    auto state = system.initial_state();
    system.energy(state);
    taut::linearize(system, state);
    taut::SymplecticEuler stepper(system);
    if (!stepper.step(state, 0.01)) return;
}
