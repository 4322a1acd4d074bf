// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <taut/contact/contacts.hpp>

#include "../support/random_system.hpp"

namespace taut_test {

/// A turn by at most so many radians.
template <class Scalar, int Dim>
auto turn(Random& random, double most) {
    taut::Pose<Scalar, Dim> pose;
    const auto angle = static_cast<Scalar>(random.uniform(-most, most));
    if constexpr (Dim == 3) {
        const Eigen::Matrix<Scalar, 3, 1> axis = random.vector<Scalar, 3>(-1, 1).normalized();
        pose.rotation = Eigen::AngleAxis<Scalar>(angle, axis).toRotationMatrix();
    } else if constexpr (Dim == 2) {
        pose.rotation = Eigen::Rotation2D<Scalar>(angle).toRotationMatrix();
    }
    return pose;
}

/// A body of any kind, with or without friction and thickness.
template <class System>
void add_some_body(Random& random, taut::Contacts<System>& contacts,
                   const taut::Pose<typename System::Scalar, System::Dim>& pose) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    taut::BodyOptions options;
    if (random.below(2) > 0) options.friction = random.uniform(0, 2);
    if (random.below(2) > 0) options.thickness = random.uniform(0, 0.1);
    const auto radius = static_cast<Scalar>(random.uniform(0.05, 0.6));
    switch (random.below(4)) {
        case 0:
            if constexpr (Dim > 1) {
                const Vector a = random.vector<Scalar, Dim>(-0.5, 0.5);
                const Vector b = random.vector<Scalar, Dim>(-0.5, 0.5);
                contacts.add(taut::Capsule<Scalar, Dim>(a, b, radius), options, pose);
                break;
            }
            [[fallthrough]];
        case 1:
            contacts.add(taut::Sphere<Scalar, Dim>(Vector::Zero(), radius), options, pose);
            break;
        case 2:
            contacts.add(taut::Box<Scalar, Dim>(random.vector<Scalar, Dim>(0.05, 0.6)), options,
                         pose);
            break;
        default:
            contacts.add(taut::HalfSpace<Scalar, Dim>(random.vector<Scalar, Dim>(-0.5, 0.5),
                                                      random.vector<Scalar, Dim>(0.1, 1)),
                         options, pose);
    }
}

}  // namespace taut_test
