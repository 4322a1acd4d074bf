// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::ProjectiveDynamics: needs a SpringSystem

#include <taut/own_matrices/linear_system.hpp>
#include <taut/projective/projective.hpp>

void step(const taut::LinearSystem<double>& system) { taut::ProjectiveDynamics stepper(system); }
