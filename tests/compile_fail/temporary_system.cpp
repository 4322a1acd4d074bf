// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: deleted
// TIMES: 11
// What a stepper keeps a reference to must not be a temporary.

#include <taut/bdf2/bdf2.hpp>
#include <taut/constraints/constraints.hpp>
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/newton/newton.hpp>
#include <taut/projective/projective.hpp>
#include <taut/taut.hpp>

using Cloth = taut::SpringSystem<double, 3>;
Cloth make();
const Cloth make_const();

void steppers() {
    taut::Bdf2 bdf2(make());
    taut::ConstrainedEuler constrained(make());
    taut::EnergyStableEuler energy_stable(make());
    taut::ExplicitEuler explicit_euler(make());
    taut::Guarded<taut::SymplecticEuler<Cloth>> guarded(make());
    taut::ImplicitEuler implicit_euler(make());
    taut::NewtonEuler newton(make());
    taut::ProjectiveDynamics projective(make());
    taut::SymplecticEuler symplectic(make());
    taut::SymplecticEuler of_const(make_const());
    taut::VelocityVerlet verlet(make());
}
