// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/network/spring_system.hpp>

namespace taut_test {

/// Masses 1, 2, 3 at (0, 0), (3, 0), (3, 4), and two springs.
inline taut::SpringSystem<double, 2> triangle() {
    taut::SpringSystem<double, 2> system;
    system.add_particle({0, 0}, 1);
    system.add_particle({3, 0}, 2);
    system.add_particle({3, 4}, 3);
    system.add_spring(0, 1, 10);
    system.add_spring(1, 2, 20, 0.5);
    return system;
}

}  // namespace taut_test
