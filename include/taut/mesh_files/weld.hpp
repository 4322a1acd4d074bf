// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "../core/error.hpp"
#include "../core/types.hpp"

namespace taut {

/// A mesh whose vertices that stand at one place are one.
struct WeldedMesh {
    std::vector<Index> vertex;              ///< that each vertex became; itself where it stayed
    std::vector<std::vector<Index>> faces;  ///< without corners that became their neighbour's
    Index welded = 0;                       ///< vertices that became another
};

/// Welds each vertex to the first one within the distance that stayed. Mesh files repeat a vertex
/// along seams, where it has two texture coordinates or normals; springs would leave a cut there.
/// A face of which two corners stay apart becomes an edge; one of which no two do is left out; one
/// that meets itself at a corner becomes its edges.
/// @param vertices  3 × V, m, finite   @param faces  corner indices, in range
/// @param distance  m, ≥ 0; 0 welds equal positions alone
/// @throws naming what is out of range
template <class Scalar>
WeldedMesh weld_vertices(const Points<Scalar, 3>& vertices,
                         const std::vector<std::vector<Index>>& faces, double distance = 0);

namespace scene_detail {

/// Finds vertices by cells of a grid that are as wide as the search reaches.
template <class Scalar>
class VertexGrid {
public:
    VertexGrid(const Points<Scalar, 3>& vertices, double reach)
        : vertices_(vertices), reach_(reach) {
        const double size =
            vertices.size() > 0 ? static_cast<double>(vertices.cwiseAbs().maxCoeff()) : 0;
        // A little wider than the reach, for rounding, and never so narrow that 64 bits overflow.
        width_ = (std::max)({1.01 * reach, 1e-12 * size, (std::numeric_limits<double>::min)()});
    }
    void add(Index v) { cells_[key(cell(v))].push_back(v); }
    /// The least of the vertices added within reach of v, or v.
    Index first_near(Index v) const {
        const Cell at = cell(v);
        Index first = v;
        for (std::int64_t i = -1; i <= 1; ++i)
            for (std::int64_t j = -1; j <= 1; ++j)
                for (std::int64_t k = -1; k <= 1; ++k)
                    first = (std::min)(first, first_in({at[0] + i, at[1] + j, at[2] + k}, v));
        return first;
    }

private:
    using Cell = std::array<std::int64_t, 3>;

    Cell cell(Index v) const {
        Cell cell{};
        for (std::size_t c = 0; c < 3; ++c) {
            cell[c] = static_cast<std::int64_t>(
                std::floor(static_cast<double>(vertices_(static_cast<Index>(c), v)) / width_));
        }
        return cell;
    }
    static std::uint64_t key(const Cell& cell) {
        std::uint64_t key = 0;
        for (const std::int64_t c : cell)
            key = (key ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15U + (key >> 29U);
        return key;
    }
    Index first_in(const Cell& cell, Index v) const {
        const auto found = cells_.find(key(cell));
        if (found == cells_.end()) return v;
        for (const Index other : found->second) {
            const Eigen::Vector3d apart =
                (vertices_.col(other) - vertices_.col(v)).template cast<double>();
            if (apart.norm() <= reach_) return other;
        }
        return v;
    }

    const Points<Scalar, 3>& vertices_;
    double reach_;
    double width_;
    std::unordered_map<std::uint64_t, std::vector<Index>> cells_;
};

/// Appends what is left of a face when its corners are those of the welded mesh.
inline void add_welded(std::vector<Index> face, std::vector<std::vector<Index>>& faces) {
    face.erase(std::unique(face.begin(), face.end()), face.end());
    while (face.size() > 1 && face.front() == face.back()) face.pop_back();
    if (face.size() < 2) return;
    auto sorted = face;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) {
        faces.push_back(std::move(face));
        return;
    }
    for (std::size_t i = 0; i < face.size(); ++i) {
        faces.push_back({face[i], face[(i + 1) % face.size()]});
    }
}

}  // namespace scene_detail

template <class Scalar>
WeldedMesh weld_vertices(const Points<Scalar, 3>& vertices,
                         const std::vector<std::vector<Index>>& faces, double distance) {
    require_non_negative("weld_vertices", "distance", distance);
    WeldedMesh mesh;
    scene_detail::VertexGrid<Scalar> stayed(vertices, distance);
    for (Index v = 0; v < vertices.cols(); ++v) {
        if (!detail::all_finite(vertices.col(v).eval())) {
            fail("weld_vertices: the position of vertex ", v, " is not finite");
        }
        mesh.vertex.push_back(stayed.first_near(v));
        if (mesh.vertex.back() == v) {
            stayed.add(v);
        } else {
            ++mesh.welded;
        }
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
        std::vector<Index> corners;
        for (const Index corner : faces[f]) {
            if (corner < 0 || corner >= vertices.cols()) {
                fail("weld_vertices: face ", f, " names vertex ", corner, "; the mesh has ",
                     vertices.cols(), " vertices, numbered from 0");
            }
            corners.push_back(mesh.vertex[static_cast<std::size_t>(corner)]);
        }
        scene_detail::add_welded(std::move(corners), mesh.faces);
    }
    return mesh;
}

}  // namespace taut
