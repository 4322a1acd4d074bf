// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <limits>

#include "../core/error.hpp"
#include "../core/types.hpp"
#include "obstacle_concept.hpp"

namespace taut {

/// Where a point stands to an obstacle.
template <class Scalar, int Dim>
struct Surface {
    Scalar distance;                       ///< to the surface, m; negative inside
    Eigen::Matrix<Scalar, Dim, 1> normal;  ///< unit, the way out: the gradient of the distance
};

// An obstacle is any class with `Surface<Scalar, Dim> surface(point) const`, so an engine's own
// collision query fits resolve_contacts as well as these two; require_obstacle names what it lacks.

/// All points on the far side of a plane: distance = normal·(x − point).
template <class Scalar, int Dim>
class HalfSpace {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    /// @param point   on the plane, m, finite
    /// @param normal  out of the half-space, of any length but 0
    HalfSpace(const Vector& point, const Vector& normal)
        : point_(point), normal_(normal.stableNormalized()) {
        if (!detail::all_finite(point)) fail("HalfSpace: point is not finite");
        if (!detail::all_finite(normal) || !(normal_.squaredNorm() > Scalar(0.5))) {
            fail("HalfSpace: normal must be finite and not zero");
        }
    }
    /// @param x  m
    Surface<Scalar, Dim> surface(const Vector& x) const {
        return {normal_.dot(x - point_), normal_};
    }

private:
    Vector point_;   // m
    Vector normal_;  // unit
};

/// A ball: distance = ‖x − centre‖ − radius. From the centre itself the way out is along the last
/// axis.
template <class Scalar, int Dim>
class Sphere {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    /// @param centre  m, finite   @param radius  m, finite and > 0
    Sphere(const Vector& centre, Scalar radius) : centre_(centre), radius_(radius) {
        if (!detail::all_finite(centre)) fail("Sphere: centre is not finite");
        require_positive("Sphere", "radius", radius);
    }
    /// Above the last axis at the centre, where no way out is the shortest. @param x  m
    Surface<Scalar, Dim> surface(const Vector& x) const {
        const Vector out = x - centre_;
        const Scalar length = out.stableNorm();
        if (length < (std::numeric_limits<Scalar>::min)()) {
            return {-radius_, Vector::Unit(Dim - 1)};
        }
        return {length - radius_, out / length};
    }

private:
    Vector centre_;  // m
    Scalar radius_;  // m
};

}  // namespace taut
