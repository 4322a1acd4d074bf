// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/buffer.hpp"
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

namespace contact_detail {

/// Divides vectors, a lane each, by their lengths; what is about 0 stays so. @returns the lengths
template <class Scalar, int Dim, class Real>
EIGEN_ALWAYS_INLINE Real normalize(detail::Few<Real, Dim>& v) {
    Real length2(Scalar(0));
    for (int d = 0; d < Dim; ++d) length2 += v[d] * v[d];
    const Real by_length =
        reciprocal_sqrt(larger(length2, Real((std::numeric_limits<Scalar>::min)())));
    for (int d = 0; d < Dim; ++d) v[d] *= by_length;
    return length2 * by_length;
}

}  // namespace contact_detail

// A convex shape of Taut's answers for a register of points, too: query(y, normal) gives distances
// and normals, lane by lane those of surface() to rounding.

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
    /// The same of registers: Few<Real, Dim>.
    template <class Real>
    EIGEN_ALWAYS_INLINE Real query(const detail::Few<Real, Dim>& y,
                                   detail::Few<Real, Dim>& normal) const {
        Real distance(-normal_.dot(point_));
        for (int d = 0; d < Dim; ++d) {
            normal[d] = Real(normal_[d]);
            distance += normal[d] * y[d];
        }
        return distance;
    }
    /// How far from the origin its points are, m.
    Scalar extent() const { return std::numeric_limits<Scalar>::infinity(); }
    /// The radius of a ball that fits in anywhere, m.
    Scalar inner() const { return std::numeric_limits<Scalar>::infinity(); }

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
    /// The same of registers: Few<Real, Dim>.
    template <class Real>
    EIGEN_ALWAYS_INLINE Real query(const detail::Few<Real, Dim>& y,
                                   detail::Few<Real, Dim>& normal) const {
        for (int d = 0; d < Dim; ++d) normal[d] = y[d] - Real(centre_[d]);
        return contact_detail::normalize<Scalar, Dim>(normal) - Real(radius_);
    }
    /// How far from the origin its points are, m.
    Scalar extent() const { return centre_.norm() + radius_; }
    /// The radius of a ball that fits in anywhere, m.
    Scalar inner() const { return radius_; }

private:
    Vector centre_;  // m
    Scalar radius_;  // m
};

/// All points within a radius of a segment.
template <class Scalar, int Dim>
class Capsule {
    static_assert(Dim > 1, "taut::Capsule: in one dimension it is a Box");

public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    /// @param a, b  the segment's ends, m, finite   @param radius  m, finite and > 0
    Capsule(const Vector& a, const Vector& b, Scalar radius)
        : a_(a), axis_(b - a), radius_(radius) {
        if (!detail::all_finite(a) || !detail::all_finite(b)) fail("Capsule: an end is not finite");
        require_positive("Capsule", "radius", radius);
        const Scalar length2 = axis_.squaredNorm();
        by_length2_ = length2 > 0 ? 1 / length2 : Scalar(0);
    }
    /// Across the axis on the axis itself. @param x  m
    Surface<Scalar, Dim> surface(const Vector& x) const {
        const Vector from_a = x - a_;
        const Scalar along =
            (std::min)((std::max)(from_a.dot(axis_) * by_length2_, Scalar(0)), Scalar(1));
        const Vector out = from_a - along * axis_;
        const Scalar length = out.norm();
        if (!(length > radius_ * std::numeric_limits<Scalar>::epsilon())) {
            return {length - radius_, across()};
        }
        return {length - radius_, out / length};
    }

    /// The same of registers: Few<Real, Dim>.
    template <class Real>
    EIGEN_ALWAYS_INLINE Real query(const detail::Few<Real, Dim>& y,
                                   detail::Few<Real, Dim>& normal) const {
        const Real zero(Scalar(0)), one(Scalar(1));
        Real along = zero;
        for (int d = 0; d < Dim; ++d) {
            normal[d] = y[d] - Real(a_[d]);
            along += normal[d] * Real(axis_[d] * by_length2_);
        }
        along = larger(along, zero);
        along = where_less(along, one, along, one);
        for (int d = 0; d < Dim; ++d) normal[d] = normal[d] - along * Real(axis_[d]);
        return contact_detail::normalize<Scalar, Dim>(normal) - Real(radius_);
    }
    /// How far from the origin its points are, m.
    Scalar extent() const { return (std::max)(a_.norm(), (a_ + axis_).norm()) + radius_; }
    /// The radius of a ball that fits in anywhere, m.
    Scalar inner() const { return radius_; }

private:
    /// A unit vector across the axis.
    Vector across() const {
        Index least = 0;
        axis_.cwiseAbs().minCoeff(&least);
        const Vector unit = Vector::Unit(least);
        const Vector rest = unit - unit.dot(axis_) * by_length2_ * axis_;
        return rest.normalized();
    }

    Vector a_, axis_;    // m
    Scalar by_length2_;  // 1/|axis|², 1/m²
    Scalar radius_;      // m
};

/// A box about the origin, its faces across the axes.
template <class Scalar, int Dim>
class Box {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    /// @param half  half of its edges, m, finite and > 0
    explicit Box(const Vector& half) : half_(half) {
        for (int d = 0; d < Dim; ++d) require_positive("Box", "an edge", half[d]);
    }
    /// Inside, the way out is to the nearest face. @param x  m
    Surface<Scalar, Dim> surface(const Vector& x) const {
        const Vector beyond = x.cwiseAbs() - half_;
        const Vector outside = beyond.cwiseMax(Scalar(0));
        const Scalar length = outside.norm();
        Vector normal = Vector::Zero();
        if (length > 0) {
            for (int d = 0; d < Dim; ++d) normal[d] = std::copysign(outside[d] / length, x[d]);
            return {length, normal};
        }
        Index nearest = 0;
        const Scalar distance = beyond.maxCoeff(&nearest);
        normal[nearest] = std::copysign(Scalar(1), x[nearest]);
        return {distance, normal};
    }
    /// The same of registers: Few<Real, Dim>.
    template <class Real>
    EIGEN_ALWAYS_INLINE Real query(const detail::Few<Real, Dim>& y,
                                   detail::Few<Real, Dim>& normal) const {
        const Real zero(Scalar(0)), one(Scalar(1));
        detail::Few<Real, Dim> sign, face;  // the way out of an axis; 1 on the nearest face's
        Real inside(Scalar(0)), outside2 = zero;
        for (int d = 0; d < Dim; ++d) {
            sign[d] = where_less(y[d], zero, -one, one);
            const Real beyond = sign[d] * y[d] - Real(half_[d]);
            normal[d] = larger(beyond, zero);
            outside2 += normal[d] * normal[d];
            face[d] = d == 0 ? one : where_less(inside, beyond, one, zero);
            for (int e = 0; e < d; ++e) face[e] = where_less(inside, beyond, zero, face[e]);
            inside = d == 0 ? beyond : larger(inside, beyond);
        }
        const Real length = contact_detail::normalize<Scalar, Dim>(normal);
        for (int d = 0; d < Dim; ++d)
            normal[d] = sign[d] * where_less(zero, outside2, normal[d], face[d]);
        return where_less(zero, outside2, length, inside);
    }
    /// How far from the origin its points are, m.
    Scalar extent() const { return half_.norm(); }
    /// The radius of a ball that fits in, m.
    Scalar inner() const { return half_.minCoeff(); }

private:
    Vector half_;  // m
};

}  // namespace taut
