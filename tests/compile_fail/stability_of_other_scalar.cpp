// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Stability<Scalar>: needs a system of the same Scalar
// ERRORS: 1

#include <taut/network/spring_system.hpp>
#include <taut/proof/stability.hpp>

void analyse(const taut::SpringSystem<float, 3>& system, const taut::State<float, 3>& state) {
    taut::Stability<double> stability(system, state);
}
