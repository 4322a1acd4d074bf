// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Law: Parameters needs `void require_valid(const char* where) const`
// ERRORS: 1

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

struct Unchecked : taut::Hookean {
    template <class Scalar>
    struct Parameters : Hookean::Parameters<Scalar> {
        Parameters(Scalar k = 0) : Hookean::Parameters<Scalar>{k} {}
        template <class Other>
        Parameters<Other> cast() const {
            return {static_cast<Other>(this->stiffness)};
        }

    private:
        using Hookean::Parameters<Scalar>::require_valid;
    };
};

void use(taut::SpringSystem<double, 3, Unchecked>& system) {
    system.add_spring<Unchecked>(0, 1, {10});
    auto state = system.initial_state();
    system.energy(state);
    taut::linearize(system, state);
    taut::SymplecticEuler stepper(system);
    if (!stepper.step(state, 0.01)) return;
}
