// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../../core/detail/finite.hpp"
#include "../../core/types.hpp"

namespace taut::solids_detail {

/// The convex hull of points, point by point: the triangles that a new point sees go, and their
/// rim is joined to it. Points are rounded to a grid, on which it is decided exactly what is seen,
/// so that many points may lie in a plane.
class Hull {
public:
    /// @param points  m, finite
    explicit Hull(const Points<double, 3>& points) {
        if (points.cols() < 4) return;
        const Eigen::Vector3d low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
        size_ = (high - low).maxCoeff();
        if (!(size_ > 0) || !detail::is_finite(size_)) return;
        const double cell = std::exp2(std::ceil(std::log2(size_)) - grid_bits);
        grid_ = (((points.colwise() - low) / cell).array() + 0.5).matrix().cast<std::int64_t>();
        points_ = (grid_.cast<double>() * cell).colwise() + low;
        if (!begin()) return;
        for (Index i = 0; i < points_.cols(); ++i) add(i);
        for (const auto& [a, b, c] : triangles_) {
            const Place area = way(a, b).cross(way(a, c));
            const Eigen::Vector3d normal = area.cast<double>().normalized();
            const auto same = [&](const Plane& plane) {
                return (plane.normal - normal).norm() < 1e-12;
            };
            if (std::none_of(planes_.begin(), planes_.end(), same))
                planes_.push_back({points_.col(a), normal});
        }
    }

    struct Plane {
        Eigen::Vector3d point, normal;  // m; unit, out
    };
    /// Of its faces; none where all points lie in a plane.
    const std::vector<Plane>& planes() const { return planes_; }
    /// The longest edge of a box around the points, m.
    double size() const { return size_; }
    /// How deep the middle of the points is, m; 0 where they lie in a plane.
    double inner() const {
        if (planes_.empty()) return 0;
        const Eigen::Vector3d middle = points_.rowwise().mean();
        double least = std::numeric_limits<double>::infinity();
        for (const Plane& plane : planes_)
            least = (std::min)(least, plane.normal.dot(plane.point - middle));
        return least;
    }

private:
    using Place = Eigen::Matrix<std::int64_t, 3, 1>;
    static constexpr int grid_bits = 26;

    Place way(Index from, Index to) const { return grid_.col(to) - grid_.col(from); }
    /// Whether i is above the plane of a triangle. Twice the area has 55 bits and a way 27: their
    /// product is summed in two parts.
    bool sees(Index i, const Triangle& triangle) const {
        const auto& [a, b, c] = triangle;
        const Place area = way(a, b).cross(way(a, c)), to = way(a, i);
        std::int64_t upper = 0, lower = 0;
        for (int d = 0; d < 3; ++d) {
            const std::int64_t rest = area[d] & (part - 1);
            upper += (area[d] - rest) / part * to[d];
            lower += rest * to[d];
        }
        const std::int64_t rest = lower & (part - 1);
        upper += (lower - rest) / part;
        return upper > 0 || (upper == 0 && rest > 0);
    }
    static constexpr std::int64_t part = std::int64_t(1) << 27;

    /// A tetrahedron of points that are far apart.
    bool begin() {
        const auto most = [&](auto&& measure) {
            Index best = 0;
            double value = 0;
            for (Index i = 0; i < points_.cols(); ++i) {
                const double here = measure(points_.col(i).eval());
                if (!(here > value)) continue;
                value = here;
                best = i;
            }
            return best;
        };
        using Vector = Eigen::Vector3d;
        const Vector a = points_.col(0);
        const Index b = most([&](const Vector& x) { return (x - a).norm(); });
        const Vector along = points_.col(b) - a;
        const Index c = most([&](const Vector& x) { return along.cross(x - a).norm(); });
        const Vector area = along.cross(points_.col(c) - a);
        const Index d = most([&](const Vector& x) { return (std::abs)(area.dot(x - a)); });
        const bool over = sees(d, {0, b, c});
        if (!over && !sees(d, {0, c, b})) return false;
        const Index second = over ? c : b, third = over ? b : c;
        triangles_ = {{0, second, third}, {0, third, d}, {third, second, d}, {second, 0, d}};
        return true;
    }
    void add(Index i) {
        std::vector<std::pair<Index, Index>> sides;
        const auto seen = [&](const Triangle& t) {
            if (!sees(i, t)) return false;
            for (std::size_t k = 0; k < 3; ++k) sides.emplace_back(t[k], t[(k + 1) % 3]);
            return true;
        };
        triangles_.erase(std::remove_if(triangles_.begin(), triangles_.end(), seen),
                         triangles_.end());
        std::sort(sides.begin(), sides.end());
        for (const auto& [from, to] : sides) {
            if (!std::binary_search(sides.begin(), sides.end(), std::pair(to, from)))
                triangles_.push_back({from, to, i});
        }
    }

    Points<std::int64_t, 3> grid_;
    Points<double, 3> points_;  // m
    double size_ = 0;           // m
    std::vector<Triangle> triangles_;
    std::vector<Plane> planes_;
};

}  // namespace taut::solids_detail
