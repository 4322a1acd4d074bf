// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut: an implicit step of an unsymmetric system needs an unsymmetric solver

#include <Eigen/SparseCholesky>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>

using System = taut::GeneralLinearSystem<double>;

void step(const System& system) {
    taut::ImplicitEuler<System, Eigen::SimplicialLLT<taut::SparseMatrix<double>>> stepper(system);
}
