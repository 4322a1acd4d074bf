// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <taut/taut.hpp>
#include <utility>
#include <vector>

#include "mesh_file.hpp"
#include "naming.hpp"

// The scene of a program: a mesh file or a built-in cloth, as its command line describes it.

namespace example {

using System = taut::SpringSystem<double, 3>;

struct Scene {
    std::string name;
    System system;
    std::vector<std::vector<taut::Index>> faces;  // corners are particles; of two: a line
    taut::Index unused_vertices = 0;
    taut::Index stretch_springs = 0;  // they come first, the others bend
};

/// CLI11's own range checks print 309 digits.
inline CLI::Validator positive() {
    return {[](std::string& text) {
                const double value = std::strtod(text.c_str(), nullptr);
                return value > 0 && std::isfinite(value) ? "" : text + " is not finite and > 0";
            },
            "> 0"};
}
inline CLI::Validator non_negative() {
    return {[](std::string& text) {
                const double value = std::strtod(text.c_str(), nullptr);
                return value >= 0 && std::isfinite(value) ? "" : text + " is not finite and >= 0";
            },
            ">= 0"};
}
/// Of names: an empty one would be taken for an option that is not given.
inline CLI::Validator not_empty() {
    return {[](std::string& text) { return text.empty() ? "it is empty" : ""; }, ""};
}

struct SceneOptions {
    std::string mesh;
    std::string built_in;
    std::optional<int> size;  // none: 64
    double stretch = 1000;    // N/m
    double bend = 100;        // N/m
    double mass = 0.3;        // kg
    std::string pins;
    bool free = false;
    double d0 = 0;     // 1/s
    double alpha = 0;  // s

    /// Declares the options on `app`.
    void add_to(CLI::App& app) {
        auto* file = app.add_option("MESH", mesh, "an OBJ mesh, in metres (or: hanging_cloth)")
                         ->check(not_empty());
        app.add_option("--scene", built_in, "a built-in scene instead of a mesh: hanging_cloth")
            ->check(CLI::IsMember({"hanging_cloth"}))
            ->excludes(file);
        app.add_option("--size", size, "particles along a side of the built-in scene")
            ->check(CLI::Range(2, 2000))
            ->default_str("64");
        app.add_option("--stretch", stretch, "stiffness along edges and quad diagonals, N/m")
            ->check(non_negative())
            ->capture_default_str();
        app.add_option("--bend", bend, "stiffness across edges, N/m")
            ->check(non_negative())
            ->capture_default_str();
        app.add_option("--mass", mass, "of all particles together, kg")
            ->check(positive())
            ->capture_default_str();
        app.add_option("--pin", pins, "vertices to pin, from 0: 3,7,10-20 (default: none)");
        app.add_flag("--free", free, "the built-in scene without its pinned corners");
        app.add_option("--d0", d0, "mass-proportional Rayleigh damping, 1/s")
            ->check(non_negative())
            ->capture_default_str();
        app.add_option("--alpha", alpha, "stiffness-proportional Rayleigh damping, s")
            ->check(non_negative())
            ->capture_default_str();
    }
    bool given() const { return !mesh.empty() || !built_in.empty(); }
};

/// "3,7,10-20" as numbers. Throws naming --pin and the part that is wrong.
inline std::vector<taut::Index> parse_pins(const std::string& list) {
    std::vector<taut::Index> pins;
    std::stringstream parts(list);
    for (std::string part; std::getline(parts, part, ',');) {
        taut::Index first = -1;
        taut::Index last = -1;
        const char* end = part.data() + part.size();
        auto read = std::from_chars(part.data(), end, first);
        last = first;
        if (read.ec == std::errc() && read.ptr != end && *read.ptr == '-') {
            read = std::from_chars(read.ptr + 1, end, last);
        }
        if (read.ec != std::errc() || read.ptr != end || first < 0 || last < first ||
            last - first > 10'000'000) {
            throw std::runtime_error("--pin: \"" + part +
                                     "\" is not a vertex number or a range like 10-20");
        }
        for (taut::Index pin = first; pin <= last; ++pin) pins.push_back(pin);
    }
    return pins;
}

inline Scene hanging_cloth_scene(const SceneOptions& options) {
    taut::ClothOptions cloth;
    cloth.rows = cloth.columns = options.size.value_or(64);
    cloth.stretch = options.stretch;
    cloth.bend = options.bend;
    cloth.mass = options.mass;
    cloth.pin_corners = !options.free;
    Scene scene;
    scene.name = "hanging_cloth " + std::to_string(cloth.rows);
    scene.system = taut::hanging_cloth<double>(cloth);
    const taut::Index bending = cloth.bend > 0 ? 2 * cloth.rows * (cloth.rows - 2) : 0;
    scene.stretch_springs = scene.system.spring_count() - bending;
    for (taut::Index r = 0; r + 1 < cloth.rows; ++r) {
        for (taut::Index c = 0; c + 1 < cloth.columns; ++c) {
            const taut::Index i = r * cloth.columns + c;
            scene.faces.push_back({i, i + 1, i + cloth.columns + 1, i + cloth.columns});
        }
    }
    return scene;
}

/// Builds the scene. Throws with a message for the user.
inline Scene make_scene(const SceneOptions& options) {
    const bool built_in = !options.built_in.empty() || options.mesh == "hanging_cloth";
    if (!built_in && options.size) {
        throw std::runtime_error("--size: " + options.mesh + " is a mesh, whose size is its own");
    }
    if (!built_in && options.free) {
        throw std::runtime_error("--free: " + options.mesh + " is a mesh; only --pin pins it");
    }
    const auto pins = parse_pins(options.pins);
    Scene scene;
    std::vector<taut::Index> particle;
    if (built_in) {
        scene = hanging_cloth_scene(options);
    } else {
        MeshFile file = read_obj(options.mesh);
        auto mesh = naming(options.mesh, [&] {
            return taut::springs_from_mesh<double>(file.vertices, file.faces,
                                                   {options.stretch, options.bend, options.mass});
        });
        scene = {options.mesh, std::move(mesh.system), std::move(file.faces), mesh.unused_vertices,
                 mesh.stretch_springs};
        particle = std::move(mesh.particle_of_vertex);
        for (auto& face : scene.faces) {
            for (auto& corner : face) corner = particle[corner];
        }
        scene.system.set_gravity({0, -9.81, 0});
    }
    const auto vertices =
        built_in ? scene.system.size() : static_cast<taut::Index>(particle.size());
    for (const taut::Index pin : pins) {
        if (pin >= vertices) {
            throw std::runtime_error("--pin: vertex " + std::to_string(pin) + " does not exist; " +
                                     scene.name + " has " + std::to_string(vertices) +
                                     " vertices, numbered from 0");
        }
        if (!built_in && particle[pin] < 0) {
            throw std::runtime_error("--pin: vertex " + std::to_string(pin) +
                                     " is used by no face or line");
        }
        scene.system.pin(built_in ? pin : particle[pin]);
    }
    scene.system.set_rayleigh({options.d0, options.alpha});
    return scene;
}

/// One line about the scene.
inline std::string describe(const Scene& scene) {
    std::ostringstream text;
    text << scene.name << ": " << scene.system.size() << " particles ("
         << scene.system.pinned_count() << " pinned), " << scene.system.spring_count()
         << " springs";
    if (scene.unused_vertices > 0) {
        text << "; " << scene.unused_vertices << " vertices that no face or line uses are left out";
    }
    return text.str();
}

}  // namespace example
