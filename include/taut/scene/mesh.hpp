// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "../model/spring_system.hpp"

namespace taut {

/// What springs_from_mesh makes of a mesh.
struct MeshOptions {
    double stretch = 1000;  ///< along edges and quad diagonals, N/m
    double bend = 100;      ///< across the edge of two triangles, N/m; 0: none
    double mass = 0.3;      ///< of all particles together, kg, in equal parts
};

/// What springs_from_mesh returns.
template <class Scalar>
struct MeshSprings {
    SpringSystem<Scalar, 3> system;
    std::vector<Index> particle_of_vertex;  ///< −1 for a vertex that no face uses
    Index unused_vertices = 0;
    Index stretch_springs = 0;  ///< they come first
    Index bend_springs = 0;
    std::vector<Triangle>
        triangles;  ///< particle indices, for Wind: fans of the faces, taken as convex
};

/// Springs over a polygon mesh, at rest as the mesh lies: one for each edge, two more across each
/// quad, and one between the far corners of two triangles that share an edge alone (unless those
/// corners are joined already). A polygon of more than four corners counts as its fan of triangles;
/// one of two corners is an edge alone, as of a rope or a net.
/// @param vertices  3 × V, m
/// @param faces     corner indices, at least two different ones in each
/// @throws naming the face when a corner is out of range, repeated, or there are fewer than two
template <class Scalar>
MeshSprings<Scalar> springs_from_mesh(const Points<Scalar, 3>& vertices,
                                      const std::vector<std::vector<Index>>& faces,
                                      const MeshOptions& options = {});

namespace scene_detail {

/// The vertex pairs to join, in order of first appearance.
class UniqueEdges {
public:
    explicit UniqueEdges(Index vertices) : vertices_(vertices) {}

    /// Adds the pair unless it is there already. @returns whether it was new
    bool add(Index a, Index b) {
        if (!known_.insert(key(a, b)).second) return false;
        pairs_.push_back({a, b});
        return true;
    }
    const std::vector<std::array<Index, 2>>& pairs() const { return pairs_; }
    Index key(Index a, Index b) const { return std::min(a, b) * vertices_ + std::max(a, b); }

private:
    Index vertices_;
    std::unordered_set<Index> known_;
    std::vector<std::array<Index, 2>> pairs_;
};

/// The corners opposite to each edge of the triangles; an edge is bent if exactly two share it.
struct Hinge {
    std::array<Index, 2> opposite{-1, -1};
    int triangles = 0;
};

inline void require_faces(const std::vector<std::vector<Index>>& faces, Index vertices) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
        auto corners = faces[f];
        if (corners.size() < 2) {
            fail("springs_from_mesh: face ", f, " has ", corners.size(),
                 " corners; at least 2 are needed");
        }
        for (const Index corner : corners) {
            if (corner < 0 || corner >= vertices) {
                fail("springs_from_mesh: face ", f, " names vertex ", corner, "; the mesh has ",
                     vertices, " vertices, numbered from 0");
            }
        }
        std::sort(corners.begin(), corners.end());
        const auto twin = std::adjacent_find(corners.begin(), corners.end());
        if (twin != corners.end()) {
            fail("springs_from_mesh: face ", f, " names vertex ", *twin, " twice");
        }
    }
}

}  // namespace scene_detail

template <class Scalar>
MeshSprings<Scalar> springs_from_mesh(const Points<Scalar, 3>& vertices,
                                      const std::vector<std::vector<Index>>& faces,
                                      const MeshOptions& options) {
    if (faces.empty()) fail("springs_from_mesh: the mesh has no faces");
    scene_detail::require_faces(faces, vertices.cols());
    require_non_negative("springs_from_mesh", "stretch", options.stretch);
    require_non_negative("springs_from_mesh", "bend", options.bend);
    require_positive("springs_from_mesh", "mass", options.mass);
    MeshSprings<Scalar> mesh;
    auto& particle = mesh.particle_of_vertex;
    particle.assign(static_cast<std::size_t>(vertices.cols()), Index(-1));
    for (const auto& face : faces) {
        for (const Index corner : face) particle[corner] = 0;
    }
    const auto used = std::count(particle.begin(), particle.end(), Index(0));
    mesh.unused_vertices = vertices.cols() - used;
    for (Index v = 0; v < vertices.cols(); ++v) {
        if (particle[v] < 0) continue;
        if (!vertices.col(v).allFinite()) {
            fail("springs_from_mesh: the position of vertex ", v, " is not finite");
        }
        const auto mass = static_cast<Scalar>(options.mass / static_cast<double>(used));
        particle[v] = mesh.system.add_particle(vertices.col(v), mass);
    }

    scene_detail::UniqueEdges edges(vertices.cols());
    std::unordered_map<Index, scene_detail::Hinge> hinges;
    std::vector<std::array<Index, 2>> hinge_order;
    const auto add_triangle = [&](Index a, Index b, Index c) {
        const std::array<std::array<Index, 3>, 3> sides{{{a, b, c}, {b, c, a}, {c, a, b}}};
        for (const auto& [from, to, opposite] : sides) {
            edges.add(from, to);
            auto& hinge = hinges[edges.key(from, to)];
            if (hinge.triangles == 0) hinge_order.push_back({from, to});
            if (hinge.triangles < 2) hinge.opposite[hinge.triangles] = opposite;
            ++hinge.triangles;
        }
    };
    for (const auto& face : faces) {
        if (face.size() == 4) {
            for (std::size_t i = 0; i < 4; ++i) edges.add(face[i], face[(i + 1) % 4]);
            edges.add(face[0], face[2]);
            edges.add(face[1], face[3]);
        } else if (face.size() == 2) {
            edges.add(face[0], face[1]);
        } else {
            for (std::size_t i = 1; i + 1 < face.size(); ++i) {
                add_triangle(face[0], face[i], face[i + 1]);
            }
        }
    }
    mesh.stretch_springs = static_cast<Index>(edges.pairs().size());
    if (options.bend > 0) {
        for (const auto& [from, to] : hinge_order) {
            const auto& hinge = hinges[edges.key(from, to)];
            const auto [p, q] = hinge.opposite;
            if (hinge.triangles == 2 && p != q) edges.add(p, q);
        }
    }
    for (const auto& face : faces) {
        for (std::size_t i = 1; i + 1 < face.size(); ++i) {
            mesh.triangles.push_back({particle[face[0]], particle[face[i]], particle[face[i + 1]]});
        }
    }
    mesh.bend_springs = static_cast<Index>(edges.pairs().size()) - mesh.stretch_springs;
    for (std::size_t s = 0; s < edges.pairs().size(); ++s) {
        const auto [a, b] = edges.pairs()[s];
        const bool stretch = static_cast<Index>(s) < mesh.stretch_springs;
        mesh.system.add_spring(particle[a], particle[b],
                               static_cast<Scalar>(stretch ? options.stretch : options.bend));
    }
    return mesh;
}

}  // namespace taut
