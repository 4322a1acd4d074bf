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

void add(taut::Contacts<taut::SpringSystem<double, 3>>& contacts) { contacts.add(Ground{}); }
