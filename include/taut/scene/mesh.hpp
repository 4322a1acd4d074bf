// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "../core/buffer.hpp"
#include "../network/spring_system.hpp"

namespace taut {

/// What springs_from_mesh makes of a mesh.
struct MeshOptions {
    double stretch = 1000;  ///< along edges and quad diagonals, N/m
    double bend = 100;      ///< across the edge of two triangles, N/m; 0: none
    double mass = 0.3;      ///< of all particles together, kg
    /// Each vertex takes a third of the mass of the triangles around it, as a sheet of even
    /// thickness; in a mesh of lines alone, half of the lines that end there. If not, all masses
    /// are equal.
    bool mass_by_area = false;
    /// A spring of length L takes the stiffness times L̄/L, where L̄ is the mean length of the
    /// springs along edges and quad diagonals: a fine part of a mesh then stretches as a coarse one
    /// does.
    bool stiffness_by_length = false;
    RayleighDamping rayleigh = {};  ///< none unless asked for
};

/// What springs_from_mesh returns.
template <class Scalar>
struct MeshSprings {
    SpringSystem<Scalar, 3> system;
    std::vector<Index> particle_of_vertex;  ///< −1 for a vertex that no face uses
    Index unused_vertices = 0;
    Index stretch_springs = 0;  ///< they come first
    Index bend_springs = 0;
    std::vector<Triangle> triangles;  ///< particle indices: fans of the faces, taken as convex
};

/// Springs over a polygon mesh, at rest as the mesh lies: one for each edge, two more across each
/// quad, and one between the far corners of two triangles that share an edge alone (unless those
/// corners are joined already). A polygon of more than four corners counts as its fan of triangles;
/// one of two corners is an edge alone, as of a rope or a net.
/// @param vertices  3 × V, m
/// @param faces     corner indices, at least two different ones in each
/// @throws naming the face when a corner is out of range, repeated, or there are fewer than two;
/// and the vertex that has no area around it or coincides with a neighbour where an option divides
/// by it
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
    Index key(Index a, Index b) const { return (std::min)(a, b) * vertices_ + (std::max)(a, b); }

private:
    Index vertices_;
    std::unordered_set<Index> known_;
    std::vector<std::array<Index, 2>> pairs_;
};

/// The corners opposite to each edge of the triangles; an edge is bent if exactly two share it.
struct Hinge {
    std::array<Index, 2> opposite{-1, -1};
    std::size_t triangles = 0;
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

/// visit(a, b, c) for each triangle of the face's fan.
template <class Visitor>
void for_each_triangle(const std::vector<Index>& face, Visitor&& visit) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) visit(face[0], face[i], face[i + 1]);
}

/// The area around each vertex: of each of its faces an equal share for every corner, m². Without a
/// face that has any, the length: half of each of its lines, m.
template <class Scalar>
Eigen::VectorXd areas_of_vertices(const Points<Scalar, 3>& vertices,
                                  const std::vector<std::vector<Index>>& faces) {
    const Points<double, 3> x = vertices.template cast<double>();
    Eigen::VectorXd area = Eigen::VectorXd::Zero(x.cols());
    for (const auto& face : faces) {
        double whole = 0;
        for_each_triangle(face, [&](Index a, Index b, Index c) {
            const Eigen::Vector3d u = x.col(b) - x.col(a), w = x.col(c) - x.col(a);
            const Eigen::Vector3d across(u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                                         u[0] * w[1] - u[1] * w[0]);
            whole += across.norm() / 2;
        });
        for (const Index corner : face) area[corner] += whole / static_cast<double>(face.size());
    }
    if (area.sum() > 0) return area;
    for (const auto& face : faces) {
        if (face.size() != 2) continue;
        for (const Index end : face) area[end] += (x.col(face[1]) - x.col(face[0])).norm() / 2;
    }
    return area;
}

/// kg of each vertex that a face uses.
template <class Scalar>
Eigen::VectorXd masses_of_vertices(const Points<Scalar, 3>& vertices,
                                   const std::vector<std::vector<Index>>& faces,
                                   const std::vector<Index>& used, const MeshOptions& options) {
    if (!options.mass_by_area) {
        const double equal = options.mass / static_cast<double>(used.size());
        return Eigen::VectorXd::Constant(vertices.cols(), equal);
    }
    const Eigen::VectorXd area = areas_of_vertices(vertices, faces);
    const double all = area.sum();
    for (const Index v : used) {
        if (!(area[v] > 0) || !detail::is_finite(all)) {
            fail("springs_from_mesh: mass_by_area: no face around vertex ", v,
                 " has a finite area");
        }
    }
    return options.mass / all * area;
}

/// Appends the pairs that springs join: along edges and quad diagonals first, then, where they are
/// wanted, those that bend. @returns how many come first
inline Index join_corners(const std::vector<std::vector<Index>>& faces, bool bend,
                          UniqueEdges& edges) {
    std::unordered_map<Index, Hinge> hinges;
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
            for_each_triangle(face, add_triangle);
        }
    }
    const auto stretch = static_cast<Index>(edges.pairs().size());
    if (!bend) return stretch;
    for (const auto& [from, to] : hinge_order) {
        const auto& hinge = hinges[edges.key(from, to)];
        const auto [p, q] = hinge.opposite;
        if (hinge.triangles == 2 && p != q) edges.add(p, q);
    }
    return stretch;
}

/// N/m of a spring between two vertices.
template <class Scalar>
class Stiffness {
public:
    /// @param stretch  how many of the pairs stretch; they come first
    Stiffness(const Points<Scalar, 3>& vertices, const std::vector<std::array<Index, 2>>& pairs,
              std::size_t stretch, const MeshOptions& options)
        : vertices_(vertices), by_length_(options.stiffness_by_length) {
        if (!by_length_) return;
        for (std::size_t s = 0; s < stretch; ++s) {
            mean_ += length(pairs[s][0], pairs[s][1]) / static_cast<double>(stretch);
        }
    }
    /// @param k  N/m, of a spring of the mean length
    double operator()(double k, Index a, Index b) const {
        if (!by_length_) return k;
        const double L = length(a, b);
        if (!(L > 0)) {
            fail("springs_from_mesh: stiffness_by_length: vertices ", a, " and ", b, " coincide");
        }
        return k * mean_ / L;
    }

private:
    double length(Index a, Index b) const {
        return (vertices_.col(b) - vertices_.col(a)).template cast<double>().norm();
    }

    const Points<Scalar, 3>& vertices_;
    bool by_length_;
    double mean_ = 0;  // m
};

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
    mesh.system.set_rayleigh(options.rayleigh);
    mesh.particle_of_vertex.assign(static_cast<std::size_t>(vertices.cols()), Index(-1));
    const auto particle = [&](Index v) -> Index& { return detail::at(mesh.particle_of_vertex, v); };
    for (const auto& face : faces) {
        for (const Index corner : face) particle(corner) = 0;
    }
    std::vector<Index> used;
    for (Index v = 0; v < vertices.cols(); ++v) {
        if (particle(v) < 0) continue;
        if (!detail::all_finite(vertices.col(v).eval())) {
            fail("springs_from_mesh: the position of vertex ", v, " is not finite");
        }
        used.push_back(v);
    }
    mesh.unused_vertices = vertices.cols() - static_cast<Index>(used.size());
    const Eigen::VectorXd mass = scene_detail::masses_of_vertices(vertices, faces, used, options);
    for (const Index v : used) {
        particle(v) = mesh.system.add_particle(vertices.col(v), static_cast<Scalar>(mass[v]));
    }
    scene_detail::UniqueEdges edges(vertices.cols());
    mesh.stretch_springs = scene_detail::join_corners(faces, options.bend > 0, edges);
    mesh.bend_springs = static_cast<Index>(edges.pairs().size()) - mesh.stretch_springs;
    for (const auto& face : faces) {
        scene_detail::for_each_triangle(face, [&](Index a, Index b, Index c) {
            mesh.triangles.push_back({particle(a), particle(b), particle(c)});
        });
    }
    const auto stretch = static_cast<std::size_t>(mesh.stretch_springs);
    const scene_detail::Stiffness stiffness(vertices, edges.pairs(), stretch, options);
    for (std::size_t s = 0; s < edges.pairs().size(); ++s) {
        const auto [a, b] = edges.pairs()[s];
        const double k = stiffness(s < stretch ? options.stretch : options.bend, a, b);
        mesh.system.add_spring(particle(a), particle(b), static_cast<Scalar>(k));
    }
    return mesh;
}

}  // namespace taut
