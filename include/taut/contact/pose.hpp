// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "../core/types.hpp"

namespace taut {

/// Where a body is: its point y stands at rotation·y + position.
template <class Scalar, int Dim>
struct Pose {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Rotation = Eigen::Matrix<Scalar, Dim, Dim>;

    Vector position = Vector::Zero();          ///< m
    Rotation rotation = Rotation::Identity();  ///< orthonormal, of determinant 1

    /// A point of the body in the world, m.
    Vector operator()(const Vector& y) const { return rotation * y + position; }
    /// A point of the world in the body, m.
    Vector inside(const Vector& x) const { return rotation.transpose() * (x - position); }
};

namespace contact_detail {

/// The pose a share of the way from one to another: along the straight line, about one axis.
template <class Scalar>
Pose<Scalar, 3> between(const Pose<Scalar, 3>& from, const Pose<Scalar, 3>& to, Scalar share) {
    using Quaternion = Eigen::Quaternion<Scalar>;
    const Quaternion rotation =
        Quaternion(from.rotation).slerp(share, Quaternion(to.rotation)).normalized();
    return {from.position + share * (to.position - from.position), rotation.toRotationMatrix()};
}
template <class Scalar>
Pose<Scalar, 2> between(const Pose<Scalar, 2>& from, const Pose<Scalar, 2>& to, Scalar share) {
    const Eigen::Matrix<Scalar, 2, 2> turn = to.rotation * from.rotation.transpose();
    const Scalar angle = share * std::atan2(turn(1, 0), turn(0, 0));
    return {from.position + share * (to.position - from.position),
            Eigen::Rotation2D<Scalar>(angle).toRotationMatrix() * from.rotation};
}
template <class Scalar>
Pose<Scalar, 1> between(const Pose<Scalar, 1>& from, const Pose<Scalar, 1>& to, Scalar share) {
    return {from.position + share * (to.position - from.position), from.rotation};
}

}  // namespace contact_detail
}  // namespace taut
