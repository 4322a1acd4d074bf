// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The largest time step of each integrator that is proved, at this pose, at any, or for the energy,
// and the feasible damping window, of a mesh, of a built-in scene, or of your own matrices.

#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/tight/tight.hpp>
#include <taut/proof/bracket.hpp>

#include "common/lammps_files.hpp"
#include "common/main.hpp"
#include "common/matrix_market.hpp"
#include "common/naming.hpp"
#include "common/output_text.hpp"
#include "common/progress.hpp"
#include "common/report.hpp"
#include "common/scene.hpp"
#include "report/page.hpp"

namespace {

using example::Findings;
using example::naming;
using example::Progress;
using taut::Method;

struct Options {
    example::SceneOptions scene;
    std::string stiffness_matrix;
    std::string mass_matrix;
    std::string damping_matrix;
    double step = 0;  // s; 0: half the symplectic limit
    bool zero_modes = false;
    bool proof = false;             // narrow the brackets by factorisations
    bool any_pose = false;          // narrow the any-pose limit
    int blame = 0;                  // springs and particles to name
    double want_step = 0;           // s; 0: none
    std::optional<double> resolve;  // of the scene's size
    double duration = 2;            // s, that --resolve is about
    std::string json;
    std::string html;
    std::string lammps;  // folder
};

constexpr double proof_tightness = 1e-6;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void analyse(const taut::Stability<double>& stability, const Options& options, Progress& progress,
             Findings& found) {
    progress.at(options.proof ? "narrowing the limits by factorisations" : "bounding the limits");
    found.degrees_of_freedom = stability.size();
    found.spectrum = taut::stiffness_spectrum(stability);
    if (options.zero_modes) found.zero_modes = taut::count_zero_modes(stability);
    const double tightness = options.proof ? proof_tightness : 0;
    found.explicit_euler = taut::max_step(stability, Method::explicit_euler, tightness);
    found.symplectic_euler = taut::max_step(stability, Method::symplectic_euler, tightness);
    found.implicit_euler = taut::max_step(stability, Method::implicit_euler, tightness);
    if (options.proof) {
        // The wanted step, or the largest that the bracket says can be had.
        const double h =
            options.want_step > 0 ? options.want_step : found.symplectic_euler.certified;
        if (h > 0 && std::isfinite(h))
            found.proof = taut::certify(stability, Method::symplectic_euler, h);
    }
    const auto limiting_mode = [&]() -> const taut::Mode& {
        if (!found.limiting_mode) {
            progress.at("finding the limiting vibration");
            found.limiting_mode = taut::limiting_mode(stability);
        }
        return *found.limiting_mode;
    };
    if (!options.html.empty()) limiting_mode();
    if (options.blame > 0) {
        const auto& mode = limiting_mode();
        found.springs_to_blame = taut::limiting_springs(stability, options.blame, mode);
        found.particles_to_blame = taut::limiting_particles(stability, options.blame, mode);
        double squares = 0;
        for (const auto& one : taut::limiting_particles(stability, stability.size(), mode))
            squares += one.share * one.share;
        found.participants = squares > 0 ? 1 / squares : 0;
    }
    const auto verdict = [&](double h) {
        return example::judge(stability, found.symplectic_euler, limiting_mode, h);
    };
    if (options.step > 0) found.verdict = verdict(options.step);
    if (options.want_step > 0) found.remedies = {verdict(options.want_step), {}};
    found.window_step = options.step;
    if (found.window_step == 0) {
        const double limit = found.symplectic_euler.certified;
        found.window_step = limit > 0 && std::isfinite(limit) ? limit / 2 : 1.0 / 60;
    }
    found.window =
        stability.rayleigh_window(Method::explicit_euler, found.window_step, options.scene.d0);
}

Findings report_on_scene(const Options& options, Progress& progress) {
    Findings found;
    const auto start = std::chrono::steady_clock::now();
    progress.at("reading the scene");
    const auto scene = example::make_scene(options.scene);
    const auto state = scene.system.initial_state();
    found.setup = seconds_since(start);
    found.name = example::describe(scene);
    found.space = example::describe_space(scene);
    found.particles = scene.system.size();
    found.springs = scene.system.spring_count();
    const auto analysis = std::chrono::steady_clock::now();
    const taut::Stability<double> stability(scene.system, state);
    analyse(stability, options, progress, found);
    progress.at("bounding the limits at any pose");
    const double tightness = options.proof || options.any_pose ? proof_tightness : 0;
    found.any_pose = taut::any_pose_limit(scene.system, tightness);
    found.energy_stable = taut::energy_limit(scene.system, tightness);
    if (found.remedies) {
        progress.at("looking for what makes the wanted step safe");
        found.remedies->cures = example::cures_at_any_pose(scene.system, state, options.want_step);
    }
    if (options.resolve) {
        progress.at("looking for how few particles would do");
        found.resolution = {options.duration,
                            taut::resolve(scene.system, state, options.duration, *options.resolve),
                            {}};
    }
    found.analysis = seconds_since(analysis);
    if (!options.lammps.empty()) {
        progress.at("writing the files for LAMMPS");
        found.lammps =
            example::write_lammps_folder("--lammps", options.lammps, scene.system, state);
    }
    if (!options.html.empty()) example::set_page(found, stability, scene, progress);
    return found;
}

/// One matrix is added after the other, so that a complaint is about the file that is named. The
/// masses come first: they say how large the others are.
taut::LinearSystem<double> read_system(const Options& options) {
    using Matrix = taut::SparseMatrix<double>;
    using System = taut::LinearSystem<double>;
    const auto M = example::read_matrix_market(options.mass_matrix).mass_matrix();
    const auto matrix = [&M](const std::string& path) {
        return example::read_matrix_market(path).matrix(M.rows());
    };
    const auto massive = naming(options.mass_matrix, [&] {
        return System(taut::diagonal_mass(M), {}, Matrix(M.rows(), M.cols()));
    });
    const auto stiffness = matrix(options.stiffness_matrix);
    const auto undamped =
        naming(options.stiffness_matrix, [&] { return System(massive.mass(), {}, stiffness); });
    if (options.damping_matrix.empty()) return undamped;
    const auto damping = matrix(options.damping_matrix);
    return naming(options.damping_matrix,
                  [&] { return System(massive.mass(), damping, undamped.stiffness()); });
}

Findings report_on_matrices(const Options& options, Progress& progress) {
    Findings found;
    const auto start = std::chrono::steady_clock::now();
    const auto system = read_system(options);
    found.setup = seconds_since(start);
    found.name = options.stiffness_matrix;
    const auto analysis = std::chrono::steady_clock::now();
    const taut::Stability<double> stability(system);
    analyse(stability, options, progress, found);
    if (found.remedies) found.remedies->cures = example::cures(stability, options.want_step);
    found.analysis = seconds_since(analysis);
    if (!options.html.empty()) {
        std::optional<taut::RayleighDamping> undamped;
        if (options.damping_matrix.empty()) undamped.emplace();
        example::set_page(found, stability, undamped);
    }
    return found;
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app{
        "Largest time step of each integrator that is proved at this pose, at any pose, or for "
        "the\n"
        "energy, and the feasible damping."};
    example::add_version(app, "stability_report");
    options.scene.add_to(app);
    auto* K = app.add_option("--stiffness-matrix", options.stiffness_matrix,
                             "K in Matrix Market form, N/m, instead of a scene")
                  ->check(example::not_empty());
    auto* M = app.add_option("--mass-matrix", options.mass_matrix, "M, diagonal, kg")
                  ->check(example::not_empty());
    app.add_option("--damping-matrix", options.damping_matrix, "D, N s/m")
        ->check(example::not_empty())
        ->needs(K);
    K->needs(M);
    M->needs(K);
    app.add_option("--step", options.step,
                   "say what holds at step H, s, or as 1/240 or 0.5ms: whether it is safe, and "
                   "its damping window (default: the window of half the limit)")
        ->transform(example::time_quantity())
        ->check(example::positive());
    app.add_flag("--zero-modes", options.zero_modes, "count rigid motions and mechanisms");
    app.add_flag("--proof", options.proof, "narrow the limits to 1e-6 by proved factorisations");
    app.add_flag("--any-pose", options.any_pose,
                 "narrow the limits at any pose and of the energy likewise");
    app.add_option("--blame", options.blame, "name the N springs and particles that limit the step")
        ->check(CLI::Range(0, 1'000'000));
    app.add_option("--want-step", options.want_step,
                   "say what would make step H, s, or as 1/240, safe")
        ->transform(example::time_quantity())
        ->check(example::positive());
    auto* resolve =
        app.add_option("--resolve", options.resolve,
                       "say how few particles keep positions within this share of the scene's "
                       "size: 0.03, or 3%")
            ->transform(example::share_quantity())
            ->check(example::positive());
    app.add_option("--duration", options.duration, "for how long, of --resolve, s")
        ->transform(example::time_quantity())
        ->check(example::positive())
        ->capture_default_str()
        ->needs(resolve);
    app.add_option("--json", options.json,
                   "write the findings as JSON (- is stdout, without table)")
        ->transform(example::standard_output())
        ->check(example::not_empty());
    app.add_option("--html", options.html,
                   "write the findings as one page to look at (- is stdout, without table)")
        ->transform(example::standard_output())
        ->check(example::not_empty());
    app.add_option("--lammps", options.lammps,
                   "write the scene for LAMMPS into folder DIR, to be stepped at half of the limit "
                   "at any pose")
        ->check(example::not_empty());
    for (const char* other : {"MESH",       "--scene",        "--size",
                              "--d0",       "--alpha",        "--pin",
                              "--stretch",  "--bend",         "--mass",
                              "--any-pose", "--up",           "--flip",
                              "--gravity",  "--scale",        "--units",
                              "--weld",     "--mass-by-area", "--stiffness-by-length",
                              "--pin-box",  "--pin-top",      "--free",
                              "--resolve",  "--lammps"}) {
        K->excludes(app.get_option(other));
    }
    app.footer(
        "Questions it answers\n"
        "  How large may my step be?          stability_report cloth.obj --pin 0,10\n"
        "  My mesh is in cm, z up, seamed?    stability_report cloth.obj --units cm --up z --weld "
        "0\n"
        "  To the last digit, proved?         stability_report cloth.obj --proof\n"
        "  At any pose? For its energy?       stability_report cloth.obj --any-pose\n"
        "  Which springs limit the step?      stability_report cloth.obj --blame 5\n"
        "  What makes 1/240 s safe?           stability_report cloth.obj --want-step 1/240\n"
        "  Which damping suits my step?       stability_report cloth.obj --step 0.1ms --d0 0.5\n"
        "  How many mechanisms does it have?  stability_report cloth.obj --zero-modes\n"
        "  How few particles would do?        stability_report cloth.obj --resolve 3% --duration "
        "2\n"
        "  Can I look at it?                  stability_report cloth.obj --html report.html\n"
        "  Can LAMMPS step it on a cluster?   stability_report cloth.obj --lammps cloth\n"
        "  And my own matrices?               stability_report --stiffness-matrix K.mtx "
        "--mass-matrix M.mtx");
    CLI11_PARSE(app, argc, argv)

    if (!options.scene.given() && options.stiffness_matrix.empty()) {
        throw std::runtime_error("name a mesh, --scene or --stiffness-matrix (see --help)");
    }
    example::require_different({{"MESH", options.scene.mesh, false},
                                {"--stiffness-matrix", options.stiffness_matrix, false},
                                {"--mass-matrix", options.mass_matrix, false},
                                {"--damping-matrix", options.damping_matrix, false},
                                {"--json", options.json, true},
                                {"--html", options.html, true}});
    const Findings found = [&] {
        const bool watched = example::stderr_is_a_terminal();
        Progress progress(1,
                          watched ? example::say_on_stderr("stability_report") : Progress::Say());
        return options.stiffness_matrix.empty() ? report_on_scene(options, progress)
                                                : report_on_matrices(options, progress);
    }();
    if (options.json != "-" && options.html != "-") {
        example::print_table(found, options.scene.d0);
        if (!found.lammps.empty()) std::printf("\n%s", found.lammps.c_str());
    }
    if (!options.json.empty())
        example::write_text(example::json_text(found, options.scene.d0), "--json", options.json);
    if (!options.html.empty())
        example::write_text(example::html_text(found, options.scene.d0), "--html", options.html);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return example::guarded_main("stability_report", [&] { return run(argc, argv); });
}
