// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut: an implicit step of an unsymmetric system needs an unsymmetric solver

#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>

void step(const taut::GeneralLinearSystem<double>& system) { taut::ImplicitEuler stepper(system); }
