// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/BVH>
#include <utility>
#include <vector>

#include "../../contact/obstacle.hpp"
#include "../../core/error.hpp"

namespace taut::solids_detail {

/// A closed surface of triangles: how far a point is from the nearest one. Boxes around triangles
/// are a tree (Eigen's KdBVH); the sign is that of pseudonormals weighted by angles (Baerentzen and
/// Aanaes, 2005).
template <class Scalar>
class TriangleSurface {
public:
    using Vector = Eigen::Matrix<Scalar, 3, 1>;

    /// @param points     m, finite
    /// @param triangles  anticlockwise from outside
    TriangleSurface(const Points<Scalar, 3>& points, const std::vector<Triangle>& triangles) {
        if (!detail::all_finite(points)) fail("SolidMesh: a point is not finite");
        if (triangles.empty()) fail("SolidMesh: there is no triangle");
        const std::vector<Edge> edges = closed_edges(points.cols(), triangles);
        add_faces(points, triangles, edges);
        std::vector<int> faces(triangles.size());
        std::vector<Eigen::AlignedBox<Scalar, 3>> boxes(triangles.size());
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            faces[t] = static_cast<int>(t);
            for (const Index corner : triangles[t]) {
                boxes[t].extend(points.col(corner));
                extent_ = (std::max)(extent_, points.col(corner).norm());
            }
        }
        tree_.init(faces.begin(), faces.end(), boxes.begin(), boxes.end());
    }

    /// @param x     m
    /// @param hint  a triangle to begin with, of the last point near this one; gets the nearest
    Surface<Scalar, 3> surface(const Vector& x, int& hint) const {
        Nearest nearest;
        look_at(hint, x, nearest);
        descend(tree_.getRootIndex(), x, nearest);
        if (nearest.face < 0) return {x.norm(), x.stableNormalized()};  // beyond all numbers
        hint = nearest.face;
        const Face& face = faces_[static_cast<std::size_t>(nearest.face)];
        const Vector& outward = face.outward[static_cast<std::size_t>(nearest.feature)];
        if (nearest.feature == 0) return {outward.dot(x - face.a), outward};
        const Scalar length = std::sqrt(nearest.distance2);
        const Scalar sign = nearest.out.dot(outward) < 0 ? Scalar(-1) : Scalar(1);
        // Closer, what is left of the way is rounding.
        const Scalar least = 100 * std::numeric_limits<Scalar>::epsilon() * extent_;
        if (!(length > least)) return {sign * length, outward};
        return {sign * length, sign / length * nearest.out};
    }
    /// How far from the origin its points are, m.
    Scalar extent() const { return extent_; }

private:
    using Tree = Eigen::KdBVH<Scalar, 3, int>;

    /// From one corner to another, as a triangle's side.
    struct Edge {
        Index from, to;
        int face, side;

        bool operator<(const Edge& other) const {
            return from != other.from ? from < other.from : to < other.to;
        }
    };
    /// Features: the face is 0, corners are 1 to 3, and 4 to 6 the sides that begin there.
    struct Face {
        Vector a, ab, ac;  // m
        std::array<Vector, 7> outward;
    };
    struct Nearest {
        Scalar distance2 = std::numeric_limits<Scalar>::infinity();  // m²
        int face = -1, feature = 0;
        Vector out = Vector::Zero();  // from there to the point, m
    };

    /// All sides, in order. Fails unless each has one that goes back.
    static std::vector<Edge> closed_edges(Index points, const std::vector<Triangle>& triangles) {
        std::vector<Edge> edges;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (std::size_t side = 0; side < 3; ++side) {
                const Index from = triangles[t][side], to = triangles[t][(side + 1) % 3];
                if (from < 0 || from >= points)
                    fail("SolidMesh: triangle ", t, " has no point ", from);
                edges.push_back({from, to, static_cast<int>(t), static_cast<int>(side)});
            }
        }
        std::sort(edges.begin(), edges.end());
        for (std::size_t e = 0; e < edges.size(); ++e) {
            if (e > 0 && !(edges[e - 1] < edges[e]))
                fail("SolidMesh: two triangles have the side from ", edges[e].from, " to ",
                     edges[e].to, ": they are not the same way round, or three meet there");
        }
        for (const Edge& edge : edges) {
            const Edge back{edge.to, edge.from, 0, 0};
            if (!std::binary_search(edges.begin(), edges.end(), back))
                fail("SolidMesh: the surface is open at the side from ", edge.from, " to ",
                     edge.to);
        }
        return edges;
    }
    void add_faces(const Points<Scalar, 3>& points, const std::vector<Triangle>& triangles,
                   const std::vector<Edge>& edges) {
        using Exact = Eigen::Vector3d;
        const auto point = [&](Index i) -> Exact { return points.col(i).template cast<double>(); };
        std::vector<Exact> normals;
        Points<double, 3> of_point = Points<double, 3>::Zero(3, points.cols());
        double volume = 0;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const auto& [a, b, c] = triangles[t];
            const Exact area = (point(b) - point(a)).cross(point(c) - point(a));
            if (!(area.stableNorm() > 0)) fail("SolidMesh: triangle ", t, " has no area");
            normals.push_back(area.stableNormalized());
            volume += area.dot(point(a) - point(triangles[0][0]));
            for (std::size_t k = 0; k < 3; ++k) {
                const Exact here = point(triangles[t][k]);
                const Exact next = point(triangles[t][(k + 1) % 3]) - here;
                const Exact last = point(triangles[t][(k + 2) % 3]) - here;
                of_point.col(triangles[t][k]) +=
                    std::atan2(next.cross(last).norm(), next.dot(last)) * normals.back();
            }
        }
        if (!(volume > 0))
            fail(
                "SolidMesh: the surface is inside out, or encloses nothing: triangles go "
                "anticlockwise as seen from outside");
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const auto& [a, b, c] = triangles[t];
            Face face{
                points.col(a), points.col(b) - points.col(a), points.col(c) - points.col(a), {}};
            face.outward[0] = normals[t].template cast<Scalar>();
            for (std::size_t k = 0; k < 3; ++k) {
                const Index from = triangles[t][k], to = triangles[t][(k + 1) % 3];
                const auto back =
                    std::lower_bound(edges.begin(), edges.end(), Edge{to, from, 0, 0});
                const Exact of_side = normals[t] + normals[static_cast<std::size_t>(back->face)];
                face.outward[1 + k] = of_point.col(from).stableNormalized().template cast<Scalar>();
                face.outward[4 + k] = of_side.stableNormalized().template cast<Scalar>();
            }
            faces_.push_back(face);
        }
    }

    void descend(int node, const Vector& x, Nearest& nearest) const {
        const int *part = nullptr, *last_part = nullptr, *face = nullptr, *last_face = nullptr;
        tree_.getChildren(node, part, last_part, face, last_face);
        for (; face != last_face; ++face) look_at(*face, x, nearest);
        std::array<std::pair<Scalar, int>, 2> parts;
        std::size_t count = 0;
        for (; part != last_part; ++part)
            parts[count++] = {tree_.getVolume(*part).squaredExteriorDistance(x), *part};
        if (count == 2 && parts[1].first < parts[0].first) std::swap(parts[0], parts[1]);
        for (std::size_t k = 0; k < count; ++k) {
            if (parts[k].first < nearest.distance2) descend(parts[k].second, x, nearest);
        }
    }
    /// The nearest point of a triangle, by the regions of its plane (Ericson, Real-Time Collision
    /// Detection, 5.1.5).
    void look_at(int index, const Vector& x, Nearest& nearest) const {
        const Face& face = faces_[static_cast<std::size_t>(index)];
        const Vector ax = x - face.a;
        const Scalar bb = face.ab.squaredNorm(), bc = face.ab.dot(face.ac);
        const Scalar cc = face.ac.squaredNorm();
        const Scalar b = face.ab.dot(ax), c = face.ac.dot(ax);  // of x seen from a
        const Scalar past_b = b - bb, beside_b = c - bc;        // of x seen from b
        const Scalar beside_c = b - bc, past_c = c - cc;        // of x seen from c
        const auto take = [&](int feature, Scalar along_b, Scalar along_c) {
            const Vector out = ax - along_b * face.ab - along_c * face.ac;
            const Scalar distance2 = out.squaredNorm();
            if (distance2 < nearest.distance2) nearest = {distance2, index, feature, out};
        };
        if (b <= 0 && c <= 0) return take(1, 0, 0);
        if (past_b >= 0 && beside_b <= past_b) return take(2, 1, 0);
        if (past_c >= 0 && beside_c <= past_c) return take(3, 0, 1);
        const Scalar over_c = b * beside_b - past_b * c;
        if (over_c <= 0 && b >= 0 && past_b <= 0) return take(4, b / bb, 0);
        const Scalar over_b = beside_c * c - b * past_c;
        if (over_b <= 0 && c >= 0 && past_c <= 0) return take(6, 0, c / cc);
        const Scalar over_a = past_b * past_c - beside_c * beside_b;
        const Scalar from_b = beside_b - past_b, from_c = beside_c - past_c;
        if (over_a <= 0 && from_b >= 0 && from_c >= 0) {
            const Scalar share = from_b / (from_b + from_c);
            return take(5, 1 - share, share);
        }
        const Scalar all = over_a + over_b + over_c;
        take(0, over_b / all, over_c / all);
    }

    std::vector<Face> faces_;
    Tree tree_;
    Scalar extent_ = 0;  // m
};

}  // namespace taut::solids_detail
