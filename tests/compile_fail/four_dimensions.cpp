// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::SpringSystem<Scalar, Dim>: Dim must be 1, 2 or 3

#include <taut/network/spring_system.hpp>

void four_dimensions() { taut::SpringSystem<double, 4> system; }
