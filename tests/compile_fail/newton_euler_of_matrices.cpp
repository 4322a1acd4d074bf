// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::NewtonEuler: needs a SpringSystem

#include <taut/newton/newton.hpp>
#include <taut/own_matrices/linear_system.hpp>

void step(const taut::LinearSystem<double>& system) { taut::NewtonEuler stepper(system); }
