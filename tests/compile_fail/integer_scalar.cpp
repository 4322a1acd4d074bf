// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::SpringSystem<Scalar, Dim>: Scalar must be float, double or long double

#include <taut/network/spring_system.hpp>

taut::SpringSystem<int, 3> system_of_integers;
