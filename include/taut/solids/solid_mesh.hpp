// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "detail/triangle_surface.hpp"

namespace taut {

/// What a closed mesh of triangles encloses: an obstacle that need not be convex [T40]. The
/// distance is that to the nearest triangle, which a query seeks in a tree of boxes.
template <class Scalar>
class SolidMesh {
public:
    using Vector = Eigen::Matrix<Scalar, 3, 1>;
    static constexpr bool convex = false;

    /// @param points     3 × n, m, finite
    /// @param triangles  corners, anticlockwise as seen from outside
    /// @throws naming the triangle or the side where the mesh is open, is not the same way round
    /// everywhere, is inside out, or has a triangle without area. A mesh that cuts itself is not
    /// seen. weld_vertices closes seams.
    SolidMesh(const Points<Scalar, 3>& points, const std::vector<Triangle>& triangles)
        : surface_(points, triangles) {}

    /// @param x  m
    taut::Surface<Scalar, 3> surface(const Vector& x) const {
        int hint = 0;
        return surface_.surface(x, hint);
    }
    /// The same for points one beside the other. @param hint  0 at first; one for all of them
    taut::Surface<Scalar, 3> surface(const Vector& x, int& hint) const {
        return surface_.surface(x, hint);
    }
    /// How far from the origin its points are, m.
    Scalar extent() const { return surface_.extent(); }

private:
    solids_detail::TriangleSurface<Scalar> surface_;
};

/// Ground: the block between a height field and a floor, two triangles a cell. Its corner is at the
/// origin, rows go along y, columns along x, and z is up.
/// @param heights  z at each point, m, finite, at least 2 × 2
/// @param spacing  of rows and of columns, m, > 0   @param floor  z, m, below all of them
template <class Scalar>
SolidMesh<Scalar> height_field(const MatrixX<Scalar>& heights, Scalar spacing, Scalar floor) {
    const Index rows = heights.rows(), columns = heights.cols(), above = rows * columns;
    require_positive("height_field", "spacing", spacing);
    if (rows < 2 || columns < 2) fail("height_field: heights must be at least 2 × 2");
    if (!detail::all_finite(heights)) fail("height_field: a height is not finite");
    if (!(heights.minCoeff() > floor)) fail("height_field: floor must be below all heights");
    Points<Scalar, 3> points(3, 2 * above);
    std::vector<Triangle> triangles;
    const auto quad = [&](Index a, Index b, Index c, Index d) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
    };
    for (Index i = 0; i < rows; ++i) {
        for (Index j = 0; j < columns; ++j) {
            const Index at = i * columns + j;
            const Scalar x = spacing * static_cast<Scalar>(j), y = spacing * static_cast<Scalar>(i);
            points.col(at) << x, y, heights(i, j);
            points.col(above + at) << x, y, floor;
            if (i == 0 || j == 0) continue;
            const Index a = at - columns - 1, b = at - columns, d = at - 1;
            quad(a, b, at, d);
            quad(above + a, above + d, above + at, above + b);
            if (i == 1) quad(above + a, above + b, b, a);
            if (i == rows - 1) quad(above + at, above + d, d, at);
            if (j == 1) quad(above + d, above + a, a, d);
            if (j == columns - 1) quad(above + b, above + at, at, b);
        }
    }
    return {points, triangles};
}

}  // namespace taut
