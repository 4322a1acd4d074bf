// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cmath>

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

/// The way from one pose to another, along the straight line and about one axis: what depends on
/// these two alone is computed once.
template <class Scalar, int Dim>
class Way {
public:
    using Place = Pose<Scalar, Dim>;

    Way() = default;
    Way(const Place& from, const Place& to) : from_(from), shift_(to.position - from.position) {
        const typename Place::Rotation turn = to.rotation * from.rotation.transpose();
        if constexpr (Dim == 2) angle_ = std::atan2(turn(1, 0), turn(0, 0));
        if constexpr (Dim == 3) {
            const Eigen::AngleAxis<Scalar> by(turn);
            angle_ = by.angle();
            axis_ = by.axis();
        }
    }
    /// @param share  of the way
    Place operator()(Scalar share) const {
        Place place{from_.position + share * shift_, from_.rotation};
        if (angle_ == 0) return place;
        if constexpr (Dim == 2) {
            place.rotation =
                Eigen::Rotation2D<Scalar>(share * angle_).toRotationMatrix() * from_.rotation;
        }
        if constexpr (Dim == 3) {
            place.rotation =
                Eigen::AngleAxis<Scalar>(share * angle_, axis_).toRotationMatrix() * from_.rotation;
        }
        return place;
    }

private:
    Place from_;
    typename Place::Vector shift_ = Place::Vector::Zero();  // m
    typename Place::Vector axis_ = Place::Vector::Unit(0);
    Scalar angle_ = 0;
};

}  // namespace contact_detail
}  // namespace taut
