// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Law: slope_range must be
// ERRORS: 1

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

/// Its slope_range gives one number, so that the slopes between two lengths would not be asked for.
struct Kinked : taut::Hookean {
    template <class Scalar>
    static Scalar slope_range(const Parameters<Scalar>& p, Scalar, Scalar, Scalar) {
        return p.stiffness;
    }
};

void use(taut::SpringSystem<double, 3, Kinked>& system) {
    system.add_spring<Kinked>(0, 1, {10});
    auto state = system.initial_state();
    system.energy(state);
    taut::linearize(system, state);
    taut::SymplecticEuler stepper(system);
    if (!stepper.step(state, 0.01)) return;
}
