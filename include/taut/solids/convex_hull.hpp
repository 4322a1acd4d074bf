// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "detail/hull.hpp"
#include "detail/triangle_surface.hpp"

namespace taut {

/// The convex hull of points, an obstacle [T39].
template <class Scalar>
class ConvexHull {
public:
    using Vector = Eigen::Matrix<Scalar, 3, 1>;

    /// @param points  3 × n, m, finite, not in one plane. They are rounded to 1e-8 of their extent;
    ///                those that lie within the hull of others do not count.
    /// The time grows as n times the triangles of the hull.
    explicit ConvexHull(const Points<Scalar, 3>& points) : ConvexHull(of(points)) {}

    /// @param x  m
    taut::Surface<Scalar, 3> surface(const Vector& x) const { return surface_.surface(x); }
    /// How far from the origin its points are, m.
    Scalar extent() const { return surface_.extent(); }
    /// The radius of a ball that fits in, m.
    Scalar inner() const { return inner_; }

private:
    explicit ConvexHull(const solids_detail::Hull& hull)
        : surface_("ConvexHull", hull.points().template cast<Scalar>(), hull.triangles()),
          inner_(static_cast<Scalar>(hull.inner())) {}
    static solids_detail::Hull of(const Points<Scalar, 3>& points) {
        if (!detail::all_finite(points)) fail("ConvexHull: a point is not finite");
        solids_detail::Hull hull(points.template cast<double>());
        if (!(hull.inner() > 1e-6 * hull.size())) fail("ConvexHull: the points lie in a plane");
        return hull;
    }

    solids_detail::TriangleSurface<Scalar> surface_;
    Scalar inner_;  // m
};

}  // namespace taut
