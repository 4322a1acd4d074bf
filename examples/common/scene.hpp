// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/taut.hpp>
#include <taut/scene/mesh.hpp>
#include <utility>
#include <vector>

#include "mesh_file.hpp"
#include "naming.hpp"
#include "pins.hpp"
#include "scene_options.hpp"

namespace example {

using System = taut::SpringSystem<double, 3>;

/// The scene of a program.
struct Scene {
    std::string name;
    System system;
    std::vector<std::vector<Index>> faces;  // corners are particles; of two: a line
    Index stretch_springs = 0;              // they come first, the others bend
    // Of a mesh file: what its frames are written by.
    taut::Points<double, 3> vertices;       // as they were read
    std::vector<Index> particle_of_vertex;  // −1: no face or line uses it
    double unit = 1;                        // m
    std::string remarks;  // on vertices welded or left out, and on what was skipped

    /// The mesh's vertices, in its own units, where the particles are: 3 × V. Of a built-in scene
    /// the particles.
    taut::Points<double, 3> drawn(const taut::Points<double, 3>& particles) const {
        if (particle_of_vertex.empty()) return particles;
        taut::Points<double, 3> x = vertices;
        for (Index v = 0; v < x.cols(); ++v) {
            const Index particle = particle_of_vertex[static_cast<std::size_t>(v)];
            if (particle >= 0) x.col(v) = particles.col(particle) / unit;
        }
        return x;
    }
};

namespace detail {

inline Scene hanging_cloth_scene(const SceneOptions& options) {
    taut::ClothOptions cloth;
    cloth.rows = cloth.columns = options.size.value_or(64);
    cloth.stretch = options.stretch;
    cloth.bend = options.bend;
    cloth.mass = options.mass;
    cloth.gravity = options.gravity;
    cloth.pin_corners = !options.free;
    Scene scene;
    scene.name = "hanging_cloth " + std::to_string(cloth.rows);
    scene.system = taut::hanging_cloth<double>(cloth);
    const Index bending = cloth.bend > 0 ? 2 * cloth.rows * (cloth.rows - 2) : 0;
    scene.stretch_springs = scene.system.spring_count() - bending;
    for (Index r = 0; r + 1 < cloth.rows; ++r) {
        for (Index c = 0; c + 1 < cloth.columns; ++c) {
            const Index i = r * cloth.columns + c;
            scene.faces.push_back({i, i + 1, i + cloth.columns + 1, i + cloth.columns});
        }
    }
    return scene;
}

/// The unit vector that points up in a scene.
inline Eigen::Vector3d up_of(const SceneOptions& options) {
    const std::string axis = !options.up.empty() ? options.up : options.is_built_in() ? "z" : "y";
    return (options.flip ? -1 : 1) * Eigen::Vector3d::Unit(axis[0] - 'x');
}

inline Scene mesh_scene(const SceneOptions& options) {
    MeshFile file = read_obj(options.mesh);
    Scene scene;
    scene.name = options.mesh;
    scene.unit = options.unit();
    const taut::Points<double, 3> x = scene.unit * file.vertices;
    taut::WeldedMesh welded;
    if (options.weld) {
        welded =
            naming(options.mesh, [&] { return taut::weld_vertices(x, file.faces, *options.weld); });
        scene.faces = std::move(welded.faces);
        if (scene.faces.empty())
            throw std::runtime_error("--weld: no face of " + options.mesh + " is larger than that");
    } else {
        scene.faces = std::move(file.faces);
    }
    taut::MeshOptions springs{options.stretch, options.bend, options.mass};
    springs.mass_by_area = options.mass_by_area;
    springs.stiffness_by_length = options.stiffness_by_length;
    auto mesh = naming(options.mesh,
                       [&] { return taut::springs_from_mesh<double>(x, scene.faces, springs); });
    scene.system = std::move(mesh.system);
    scene.system.set_gravity(-options.gravity * up_of(options));
    scene.stretch_springs = mesh.stretch_springs;
    scene.vertices = std::move(file.vertices);
    auto& particle = scene.particle_of_vertex = std::move(mesh.particle_of_vertex);
    for (auto& face : scene.faces)
        for (auto& corner : face) corner = particle[corner];
    for (std::size_t v = 0; v < welded.vertex.size(); ++v) particle[v] = particle[welded.vertex[v]];
    const auto remark = [&](Index count, const char* words) {
        if (count > 0) scene.remarks += "; " + std::to_string(count) + words;
    };
    remark(welded.welded, " welded to others");
    remark(mesh.unused_vertices - welded.welded, " left out, which no face or line uses");
    if (!file.skipped.empty()) scene.remarks += "; " + file.skipped;
    return scene;
}

inline void pin(const SceneOptions& options, Scene& scene) {
    const bool built_in = scene.particle_of_vertex.empty();
    const auto& particle = scene.particle_of_vertex;
    const taut::Points<double, 3> x = built_in ? scene.system.initial_state().x : scene.vertices;
    const auto is_used = [&](Index v) { return built_in || particle[v] >= 0; };
    const auto pin_all = [&](const std::vector<Index>& vertices) {
        for (const Index v : vertices) scene.system.pin(built_in ? v : particle[v]);
    };
    const auto listed = parse_pins(options.pins);
    for (const Index v : listed) {
        if (v >= x.cols()) {
            throw std::runtime_error("--pin: vertex " + std::to_string(v) + " does not exist; " +
                                     scene.name + " has " + std::to_string(x.cols()) +
                                     " vertices, numbered from 0");
        }
        if (!is_used(v)) {
            throw std::runtime_error("--pin: vertex " + std::to_string(v) +
                                     " is used by no face or line");
        }
    }
    pin_all(listed);
    if (!options.pin_box.empty()) pin_all(vertices_in_box(x, options.pin_box, is_used));
    if (options.pin_top) pin_all(highest_vertices(x, up_of(options), *options.pin_top, is_used));
}

}  // namespace detail

/// Builds the scene. Throws with a message for the user.
inline Scene make_scene(const SceneOptions& options) {
    options.check();
    Scene scene =
        options.is_built_in() ? detail::hanging_cloth_scene(options) : detail::mesh_scene(options);
    detail::pin(options, scene);
    scene.system.set_rayleigh({options.d0, options.alpha});
    return scene;
}

/// One line about the scene.
inline std::string describe(const Scene& scene) {
    std::ostringstream text;
    text << scene.name << ": " << scene.system.size() << " particles ("
         << scene.system.pinned_count() << " pinned), " << scene.system.spring_count() << " springs"
         << scene.remarks;
    return text.str();
}

/// Its mass and stiffness.
inline std::string material(const Scene& scene) {
    double mass = 0;
    for (Index i = 0; i < scene.system.size(); ++i) mass += scene.system.mass(i);
    const auto springs = scene.system.springs();
    const auto count = static_cast<std::size_t>(springs.size());
    const auto stiffness = [&](std::size_t from, std::size_t to) {
        double least = springs[from].parameters.stiffness, most = least;
        for (std::size_t s = from; s < to; ++s) {
            least = std::min(least, springs[s].parameters.stiffness);
            most = std::max(most, springs[s].parameters.stiffness);
        }
        char text[80];
        std::snprintf(text, sizeof text, least < most ? "%.4g to %.4g N/m" : "%.4g N/m", least,
                      most);
        return std::string(text);
    };
    char text[40];
    std::snprintf(text, sizeof text, "%.4g kg", mass);
    std::string line = text;
    const auto stretch = static_cast<std::size_t>(scene.stretch_springs);
    if (stretch > 0) line += ", springs " + stiffness(0, stretch);
    if (stretch < count) line += ", across folds " + stiffness(stretch, count);
    return line;
}

/// One line about its size, which way is down and its material: where a wrong unit or axis shows,
/// and what was assumed.
inline std::string describe_space(const Scene& scene) {
    const auto x = scene.system.initial_state().x;
    const Eigen::Vector3d size = x.rowwise().maxCoeff() - x.rowwise().minCoeff();
    const Eigen::Vector3d g = scene.system.gravity();
    char text[160];
    std::snprintf(text, sizeof text, "%.3g x %.3g x %.3g m, ", size[0], size[1], size[2]);
    std::string line = text;
    if (size.maxCoeff() > 20) line += "is that in metres? (--units cm), ";
    Eigen::Index axis = 0;
    const std::string rest = "; " + material(scene);
    if (g.cwiseAbs().maxCoeff(&axis) == 0) return line + "no gravity" + rest;
    std::snprintf(text, sizeof text, "up is %c%c, gravity %.4g m/s^2", g[axis] > 0 ? '-' : '+',
                  "xyz"[axis], g.norm());
    return line + text + rest;
}

}  // namespace example
