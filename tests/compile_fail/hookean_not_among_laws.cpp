// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::SpringSystem::add_spring: the law is not one of the system's Laws

#include <taut/network/spring_system.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/laws.hpp"

void build(taut::SpringSystem<double, 3, taut_test::TensionOnly>& system) {
    system.add_spring(0, 1, 10.0);
}
