// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "../contact/obstacle.hpp"
#include "../core/error.hpp"
#include "detail/hull.hpp"

namespace taut {

/// The convex hull of points, an obstacle [T39]. The distance is that from the plane of a face from
/// which it is greatest: beside an edge or a corner it is less than to the nearest point, so with a
/// thickness edges stay sharp. A query takes time for each face.
template <class Scalar>
class ConvexHull {
public:
    using Vector = Eigen::Matrix<Scalar, 3, 1>;

    /// @param points  3 × n, m, finite, not in one plane. They are rounded to 1e-8 of their extent;
    ///                those that lie within the hull of others do not count.
    explicit ConvexHull(const Points<Scalar, 3>& points) {
        if (!detail::all_finite(points)) fail("ConvexHull: a point is not finite");
        const solids_detail::Hull hull(points.template cast<double>());
        inner_ = static_cast<Scalar>(hull.inner());
        if (!(hull.inner() > 1e-6 * hull.size())) fail("ConvexHull: the points lie in a plane");
        for (const auto& plane : hull.planes()) {
            faces_.push_back({plane.normal.template cast<Scalar>(),
                              static_cast<Scalar>(plane.normal.dot(plane.point))});
        }
        extent_ = points.colwise().norm().maxCoeff();
    }

    /// @param x  m
    Surface<Scalar, 3> surface(const Vector& x) const {
        Surface<Scalar, 3> found{-std::numeric_limits<Scalar>::infinity(), Vector::Unit(2)};
        for (const Face& face : faces_) {
            const Scalar distance = face.normal.dot(x) - face.offset;
            if (!(distance <= found.distance)) found = {distance, face.normal};
        }
        return found;
    }
    /// The same of registers: Few<Real, 3>.
    template <class Real>
    EIGEN_ALWAYS_INLINE Real query(const detail::Few<Real, 3>& y,
                                   detail::Few<Real, 3>& normal) const {
        Real greatest(-std::numeric_limits<Scalar>::infinity());
        for (const Face& face : faces_) {
            Real distance(-face.offset);
            for (int d = 0; d < 3; ++d) distance += Real(face.normal[d]) * y[d];
            for (int d = 0; d < 3; ++d)
                normal[d] = where_less(greatest, distance, Real(face.normal[d]), normal[d]);
            greatest = larger(greatest, distance);
        }
        return greatest;
    }
    /// How far from the origin its points are, m.
    Scalar extent() const { return extent_; }
    /// The radius of a ball that fits in, m.
    Scalar inner() const { return inner_; }

private:
    struct Face {
        Vector normal;  // unit
        Scalar offset;  // m
    };

    std::vector<Face> faces_;
    Scalar extent_, inner_;  // m
};

}  // namespace taut
