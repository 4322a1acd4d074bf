// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::System: needs the type `Scalar`

#include <taut/integrator/symplectic_euler.hpp>

struct NotASystem {};

void not_a_system(const NotASystem& system) { taut::SymplecticEuler<NotASystem> stepper(system); }
