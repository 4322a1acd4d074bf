// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "option_checks.hpp"

namespace example {

/// The scene of a program, as its command line describes it: a mesh file or a built-in cloth.
struct SceneOptions {
    std::string mesh;
    std::string built_in;
    std::optional<int> size;  // none: 64
    double stretch = 1000;    // N/m
    double bend = 100;        // N/m
    double mass = 0.3;        // kg
    bool mass_by_area = false;
    bool stiffness_by_length = false;
    std::string pins;
    std::vector<double> pin_box;    // the corners, in the mesh's own units; empty: none
    std::optional<double> pin_top;  // share of the vertices
    bool free = false;
    std::string up;  // x, y or z; empty: the scene's own
    bool flip = false;
    double gravity = 9.81;        // m/s²
    std::optional<double> scale;  // m a unit
    std::string units;            // empty: m
    std::optional<double> weld;   // m
    double d0 = 0;                // 1/s
    double alpha = 0;             // s

    /// Declares the options on `app`.
    void add_to(CLI::App& app);
    bool given() const { return !mesh.empty() || !built_in.empty(); }
    bool is_built_in() const { return !built_in.empty() || mesh == "hanging_cloth"; }
    /// m
    double unit() const {
        if (scale) return *scale;
        return units == "cm" ? 1e-2 : units == "mm" ? 1e-3 : units == "in" ? 0.0254 : 1;
    }
    /// Throws naming the option that does not go with the scene.
    void check() const;

private:
    void add_space(CLI::App& app);
    void add_material(CLI::App& app);
    void add_pins(CLI::App& app);
};

inline void SceneOptions::add_to(CLI::App& app) {
    auto* file = app.add_option("MESH", mesh, "an OBJ mesh, in metres (or: hanging_cloth)")
                     ->check(not_empty());
    app.add_option("--scene", built_in, "a built-in scene instead of a mesh: hanging_cloth")
        ->check(CLI::IsMember({"hanging_cloth"}))
        ->excludes(file);
    app.add_option("--size", size, "particles along a side of the built-in scene")
        ->check(CLI::Range(2, 2000))
        ->default_str("64");
    add_space(app);
    add_material(app);
    add_pins(app);
}

inline void SceneOptions::add_space(CLI::App& app) {
    app.add_option("--up", up,
                   "the mesh's axis that points up: x, y or z (default: y; of "
                   "hanging_cloth always z)")
        ->check(CLI::IsMember({"x", "y", "z"}, CLI::ignore_case));
    app.add_flag("--flip", flip, "the axis of --up points down");
    app.add_option("--gravity", gravity, "acceleration downwards, m/s^2")
        ->transform(plain_quantity())
        ->check(non_negative())
        ->capture_default_str();
    auto* metres = app.add_option("--scale", scale, "metres that a unit of the mesh stands for")
                       ->transform(plain_quantity())
                       ->check(positive());
    app.add_option("--units", units, "unit of the mesh: m, cm, mm or in (default: m)")
        ->check(CLI::IsMember({"m", "cm", "mm", "in"}, CLI::ignore_case))
        ->excludes(metres);
    app.add_option(
           "--weld", weld,
           "merge vertices that are no farther apart than this, m, or as 1mm; 0: at one place. "
           "A mesh repeats vertices along texture seams, which would come apart")
        ->transform(length_quantity())
        ->check(non_negative());
}

inline void SceneOptions::add_material(CLI::App& app) {
    app.add_option("--stretch", stretch, "stiffness along edges and quad diagonals, N/m")
        ->check(non_negative())
        ->capture_default_str();
    app.add_option("--bend", bend, "stiffness across edges, N/m")
        ->check(non_negative())
        ->capture_default_str();
    app.add_option("--mass", mass, "of all particles together, kg")
        ->check(positive())
        ->capture_default_str();
    app.add_flag("--mass-by-area", mass_by_area,
                 "masses by the area around each vertex (default: equal masses)");
    app.add_flag("--stiffness-by-length", stiffness_by_length,
                 "stiffness inverse to a spring's length; --stretch and --bend are of the mean "
                 "edge (default: equal stiffness)");
    app.add_option("--d0", d0, "damping of motion: mass-proportional Rayleigh damping, 1/s")
        ->check(non_negative())
        ->capture_default_str();
    app.add_option("--alpha", alpha,
                   "damping of springs: stiffness-proportional Rayleigh damping, s, or as 0.1ms")
        ->transform(time_quantity())
        ->check(non_negative())
        ->capture_default_str();
}

inline void SceneOptions::add_pins(CLI::App& app) {
    app.add_option("--pin", pins,
                   "vertices to pin, from 0: 3,7,10-20 (default: none; hanging_cloth: two corners)")
        ->check(not_empty());
    app.add_option("--pin-box", pin_box,
                   "pin the vertices in a box: x y z of one corner and of the opposite one, in the "
                   "mesh's units")
        ->expected(6);
    app.add_option(
           "--pin-top", pin_top,
           "pin this share of the vertices, the highest: 0.02, or 2%; at least one, and all "
           "that are as high as the lowest of them (the lab's Top edge: all within 1 % of the "
           "height)")
        ->transform(share_quantity())
        ->check(CLI::Range(0.0, 1.0));
    app.add_flag("--free", free, "the built-in scene without its pinned corners");
}

inline void SceneOptions::check() const {
    if (!given()) throw std::runtime_error("name a mesh or --scene (see --help)");
    const auto refuse = [](const char* option, const std::string& why) {
        throw std::runtime_error(std::string(option) + ": " + why);
    };
    if (!is_built_in()) {
        if (size) refuse("--size", mesh + " is a mesh, whose size is its own");
        if (free) refuse("--free", mesh + " is a mesh; only --pin, --pin-box and --pin-top pin it");
        return;
    }
    const std::pair<const char*, bool> of_meshes[] = {
        {"--up", !up.empty()},
        {"--flip", flip},
        {"--scale", scale.has_value()},
        {"--units", !units.empty()},
        {"--weld", weld.has_value()},
        {"--mass-by-area", mass_by_area},
        {"--stiffness-by-length", stiffness_by_length}};
    for (const auto& [option, is_given] : of_meshes)
        if (is_given) refuse(option, "it is for meshes; hanging_cloth is built in");
}

}  // namespace example
