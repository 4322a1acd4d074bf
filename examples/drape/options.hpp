// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "../common/scene.hpp"

namespace drape {

struct Options {
    example::SceneOptions scene;
    std::string law = "hookean";
    std::optional<double> bending;  // k_b, N·m²
    std::string integrator;         // none named: settle() chooses
    std::string solver = "cholesky";
    std::optional<double> tolerance;  // of conjugate gradients
    bool guard = false;
    double step = 0;      // s; 0: the integrator's own
    double duration = 2;  // s
    double frame_rate = 30;
    std::string collide;
    std::optional<double> radius;     // m
    std::optional<double> gap;        // m
    std::optional<double> thickness;  // m
    double friction = 0.3;
    std::string output = "drape";
    std::string format = "obj";
    std::string cache;  // path of a PC2 file
    bool springs = false;
    bool resume = false;
    std::string settings;  // a line for each option that a run must not change when it goes on
    bool quiet = false;

    /// Whether every step is stable.
    bool implicit() const { return solves() || integrator == "projective"; }
    /// Whether its steps solve a linear system that --solver may choose for.
    bool solves() const {
        return integrator == "implicit" || integrator == "newton" || integrator == "bdf2";
    }
    std::string state_path() const { return output + "/state.bin"; }
    void add_to(CLI::App& app);
    /// Fills in what the command line left open, and `settings`.
    void settle(const CLI::App& app);
    /// Throws naming the options that do not go together.
    void check() const;

private:
    void add_motion(CLI::App& app);
    void add_obstacle(CLI::App& app);
    void add_output(CLI::App& app);
};

inline void Options::add_to(CLI::App& app) {
    scene.add_to(app);
    app.add_option("--law", law,
                   "hookean: all springs pull and push; tension-only: they only pull; buckling: "
                   "as Choi and Ko, stretch springs only pull and bending springs push as a "
                   "buckled beam does")
        ->check(CLI::IsMember({"hookean", "tension-only", "buckling"}))
        ->capture_default_str();
    app.add_option("--bending", bending,
                   "flexural rigidity k_b of a bending spring under --law buckling, N m^2 "
                   "(default: a hundredth of --bend times its length cubed)")
        ->check(example::non_negative());
    add_motion(app);
    add_obstacle(app);
    add_output(app);
}

inline void Options::add_motion(CLI::App& app) {
    app.add_option("--integrator,--method", integrator,
                   "energy_stable: cannot gain energy, damps fast vibrations; symplectic, verlet, "
                   "explicit: one force a step, too; implicit: one linearised solve; newton: the "
                   "nonlinear step, solved; bdf2: second order, livelier; projective: ten "
                   "iterations with one constant factor (default: verlet with --guard)")
        ->check(CLI::IsMember({"energy_stable", "symplectic", "verlet", "explicit", "implicit",
                               "newton", "bdf2", "projective"}));
    auto* chosen =
        app.add_option("--solver", solver,
                       "of implicit, newton and bdf2: cholesky, Eigen's; conjugate_gradient, for "
                       "large cloths; cholmod, where this program was built with SuiteSparse")
            ->check(CLI::IsMember({"cholesky", "conjugate_gradient", "cholmod"}))
            ->capture_default_str();
    app.add_option("--tolerance", tolerance,
                   "relative residual at which conjugate gradients stop (default: 0.001)")
        ->check(CLI::Range(1e-15, 0.5))
        ->needs(chosen);
    app.add_flag("--guard", guard,
                 "watch the energy of every frame: trim what gained a little, and take the rest "
                 "again by the energy-stable step");
    app.add_option("--step", step,
                   "largest time step, s (default: energy_stable: the largest that is proved; "
                   "symplectic, verlet and explicit: 0.95 of the any-pose limit; implicit and "
                   "bdf2: 1/60 s; newton and projective: a frame; with --collide at most 1/240 s)")
        ->transform(example::time_quantity())
        ->check(example::positive());
    app.add_option("--duration", duration, "simulated time, s")
        ->transform(example::time_quantity())
        ->check(example::positive())
        ->capture_default_str();
    app.add_option("--frame-rate", frame_rate, "frames written per simulated second")
        ->check(example::positive())
        ->capture_default_str();
}

inline void Options::add_obstacle(CLI::App& app) {
    auto* obstacle = app.add_option("--collide", collide,
                                    "sphere or plane: an obstacle below the scene; what is pinned "
                                    "may never reach it")
                         ->check(CLI::IsMember({"sphere", "plane"}));
    app.add_option("--radius", radius, "of the sphere, m (default: 0.2 of the scene's size)")
        ->transform(example::length_quantity())
        ->check(example::positive())
        ->needs(obstacle);
    app.add_option("--gap", gap,
                   "from the scene's lowest point to the obstacle, m (default: 0.05 of its size)")
        ->transform(example::length_quantity())
        ->check(example::non_negative())
        ->needs(obstacle);
    app.add_option("--thickness", thickness,
                   "kept between particles and obstacle, m (default: 0.002 of the scene's size)")
        ->transform(example::length_quantity())
        ->check(example::non_negative())
        ->needs(obstacle);
    app.add_option("--friction", friction, "Coulomb's coefficient")
        ->check(example::non_negative())
        ->capture_default_str()
        ->needs(obstacle);
}

inline void Options::add_output(CLI::App& app) {
    app.add_option("--output", output, "folder for the frames and energy.csv")
        ->check(example::not_empty())
        ->capture_default_str();
    app.add_option("--format", format,
                   "what the frames are written as: obj, text; ply, binary, half the size")
        ->check(CLI::IsMember({"obj", "ply"}))
        ->capture_default_str();
    app.add_option("--cache", cache,
                   "a PC2 point cache too: in Blender, import the first frame and give it a Mesh "
                   "Cache modifier with this file")
        ->check(example::not_empty());
    app.add_flag("--springs", springs,
                 "frame_*.vtk too, with the tension and strain of every spring, for ParaView");
    app.add_flag(
        "--resume", resume,
        "go on from where the run before this one ended in the folder of --output, up to "
        "--duration in all; other options must be as they were; bdf2 and the guard's books "
        "begin anew there");
    app.add_flag("--quiet", quiet, "no progress line");
}

inline void Options::settle(const CLI::App& app) {
    if (integrator.empty()) {
        integrator = "verlet";
        guard = true;
    }
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = option->get_name();
        const bool may_change = name == "--duration" || name == "--output" || name == "--cache" ||
                                name == "--resume" || name == "--quiet" || name == "--help";
        if (may_change || option->count() == 0) continue;
        settings += name;
        for (const auto& value : option->results()) settings += ' ' + value;
        settings += '\n';
    }
}

inline void Options::check() const {
    scene.check();
    if (bending && law != "buckling") {
        throw std::runtime_error("--bending: it belongs to --law buckling, not to " + law);
    }
    if (radius && collide != "sphere") {
        throw std::runtime_error("--radius: it belongs to --collide sphere, not to " + collide);
    }
    if (guard && integrator == "explicit") {
        throw std::runtime_error(
            "--guard: explicit Euler has no limit that holds at every pose; use --integrator "
            "symplectic, which costs the same");
    }
    if (solver != "cholesky" && !solves()) {
        throw std::runtime_error("--solver: implicit, newton and bdf2 take it, not " + integrator);
    }
    if (tolerance && solver != "conjugate_gradient") {
        throw std::runtime_error("--tolerance: conjugate_gradient takes it, not " + solver);
    }
#ifndef DRAPE_CHOLMOD
    if (solver == "cholmod") {
        throw std::runtime_error(
            "--solver cholmod: this program was built without SuiteSparse (-D "
            "TAUT_SUITESPARSE=ON)");
    }
#endif
    if (!collide.empty() && scene.gravity == 0) {
        throw std::runtime_error("--collide: nothing falls on it with --gravity 0");
    }
    if (integrator == "explicit" && scene.d0 == 0 && scene.alpha == 0) {
        throw std::runtime_error("--integrator explicit: " +
                                 std::string(describe(taut::Cause::undamped)));
    }
}

}  // namespace drape
