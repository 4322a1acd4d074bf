// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Obstacle: what surface(point) returns needs `Vector normal`
// ERRORS: 1

#include <taut/network/spring_system.hpp>
#include <taut/contact/contact.hpp>

struct Depth {
    double distance;
};
struct Ground {
    Depth surface(const Eigen::Vector3d& x) const { return {x.z()}; }
};

void step(const taut::SpringSystem<double, 3>& system, taut::State<double, 3>& state) {
    taut::resolve_contacts(system, Ground{}, state);
}
