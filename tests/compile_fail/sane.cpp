// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: success

// What the other files of this folder do wrong, done right: this one must compile.
#include <Eigen/SparseLU>
#include <taut/constraints/constraints.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/newton/newton.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/taut.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/laws.hpp"

using General = taut::GeneralLinearSystem<double>;

void step(const General& general, const taut::LinearSystem<double>& linear) {
    taut::ImplicitEuler<General, Eigen::SparseLU<taut::SparseMatrix<double>>> unsymmetric(general);
    taut::ImplicitEuler symmetric(linear);
}

void step(const taut::SpringSystem<float, 1, taut::Hookean, taut_test::TensionOnly>& system) {
    taut::ExplicitEuler explicit_euler(system);
    taut::SymplecticEuler symplectic_euler(system);
    taut::VelocityVerlet velocity_verlet(system);
    taut::ImplicitEuler implicit_euler(system);
    taut::ConstrainedEuler constrained_euler(system);
    taut::NewtonEuler newton_euler(system);
}

void build(taut::SpringSystem<double, 3, taut_test::TensionOnly>& system) {
    system.add_spring<taut_test::TensionOnly>(0, 1, {10});
    system.add_spring(taut::Spring<double, taut_test::TensionOnly>{0, 1, {10}, 1});
}
