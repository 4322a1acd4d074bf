// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Obstacle: needs `Surface<Scalar, Dim> surface(const Vector& point) const`
// ERRORS: 1

#include <taut/network/spring_system.hpp>
#include <taut/contact/contact.hpp>

struct Ground {
    taut::Surface<double, 3> surface(const Eigen::Vector3d& x) {  // not const
        return {x.z(), Eigen::Vector3d::UnitZ()};
    }
};

void add(taut::Contacts<taut::SpringSystem<double, 3>>& contacts) { contacts.add(Ground{}); }
