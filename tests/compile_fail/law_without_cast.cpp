// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Law: Parameters needs `template <class Other> Parameters<Other> cast() const`
// ERRORS: 1

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

struct OnePrecision : taut::Hookean {
    template <class Scalar>
    struct Parameters {
        Scalar stiffness;
        void require_valid(const char*) const {}
    };
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return p.stiffness * (l - L);
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar, Scalar) {
        return p.stiffness;
    }
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return p.stiffness * (l - L) * (l - L) / 2;
    }
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar) {
        return p.stiffness;
    }
};

void use(taut::SpringSystem<double, 3, OnePrecision>& system) {
    system.add_spring<OnePrecision>(0, 1, {10});
    auto state = system.initial_state();
    system.energy(state);
    taut::linearize(system, state);
    taut::SymplecticEuler stepper(system);
    if (!stepper.step(state, 0.01)) return;
}
