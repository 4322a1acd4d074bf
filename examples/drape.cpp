// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Simulates a cloth under gravity, by default at 95 % of the step that is proved for any pose, and
// writes an OBJ sequence and the energy over time.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/main.hpp"
#include "common/scene.hpp"

namespace {

constexpr int diverged = 3;  // exit code

struct Options {
    example::SceneOptions scene;
    std::string method = "symplectic";
    double step = 0;      // s; 0: 0.95 of the any-pose limit, or a frame for the implicit method
    double duration = 2;  // s
    double frame_rate = 30;
    std::string output = "drape";
    bool quiet = false;
};

using State = example::System::State;
using Step = std::function<taut::Report(State&, double, taut::Index)>;

/// The chosen stepper behind one call; `system` must outlive it.
Step make_stepper(const std::string& method, const example::System& system) {
    const auto wrap = [](auto stepper) {
        return [stepper](State& state, double h, taut::Index count) {
            return stepper->step(state, h, count);
        };
    };
    if (method == "explicit")
        return wrap(std::make_shared<taut::ExplicitEuler<example::System>>(system));
    if (method == "verlet")
        return wrap(std::make_shared<taut::VelocityVerlet<example::System>>(system));
    if (method == "implicit")
        return wrap(std::make_shared<taut::ImplicitEuler<example::System>>(system));
    return wrap(std::make_shared<taut::SymplecticEuler<example::System>>(system));
}

double default_step(const Options& options, const example::System& system) {
    if (options.method == "implicit") return 1 / options.frame_rate;
    if (options.method == "explicit" && options.scene.d0 == 0 && options.scene.alpha == 0) {
        throw std::runtime_error("--method explicit: " +
                                 std::string(describe(taut::Cause::undamped)));
    }
    const auto limit = taut::any_pose_limit(system);
    if (limit.unbounded()) return 1 / options.frame_rate;
    if (!(limit.certified > 0)) {
        throw std::runtime_error("no step is certified: " + std::string(describe(limit.cause)));
    }
    return 0.95 * limit.certified;
}

/// A rise of the energy that no fall of the cloth by a hundred times its own size can explain.
double energy_allowance(const example::System& system, const State& state) {
    const double extent = (state.x.rowwise().maxCoeff() - state.x.rowwise().minCoeff()).norm();
    double mass = 0;
    for (taut::Index i = 0; i < system.size(); ++i) mass += system.mass(i);
    return 100 * mass * system.gravity().norm() * extent;
}

std::string frame_path(const std::string& folder, int frame) {
    char name[32];
    std::snprintf(name, sizeof name, "/frame_%05d.obj", frame);
    return folder + name;
}

/// A longer run before this one would be taken for the end of it.
void warn_of_old_frames(const std::string& folder, int first) {
    std::error_code failed;
    const std::string path = frame_path(folder, first);
    if (!std::filesystem::exists(path, failed)) return;
    std::fprintf(stderr, "drape: --output: %s and any after it are of an earlier run\n",
                 path.c_str());
}

int simulate(const Options& options, const example::Scene& scene) {
    const auto& system = scene.system;
    State state = system.initial_state();
    const Step stepper = make_stepper(options.method, system);
    const double wanted_frames = std::round(options.duration * options.frame_rate);
    if (wanted_frames > 99999) {
        throw std::runtime_error("--duration, --frame-rate: more than 99999 frames");
    }
    const int frames = std::max(1, static_cast<int>(wanted_frames));
    const double wanted = options.step > 0 ? options.step : default_step(options, system);
    const double frame_time = options.duration / frames;
    if (!(frame_time / wanted <= 1e9)) {
        throw std::runtime_error("--step: more than 1e9 steps for each frame");
    }
    const auto substeps =
        std::max<taut::Index>(1, static_cast<taut::Index>(std::ceil(frame_time / wanted)));
    const double h = frame_time / static_cast<double>(substeps);
    std::printf("%s\n%s steps of %.4e s, %lld for each of %d frames of %.4g s\n",
                example::describe(scene).c_str(), options.method.c_str(), h,
                static_cast<long long>(substeps), frames, frame_time);

    std::error_code failed;
    std::filesystem::create_directories(options.output, failed);
    const std::string table = options.output + "/energy.csv";
    std::FILE* csv = failed ? nullptr : std::fopen(table.c_str(), "w");
    if (csv == nullptr) throw std::runtime_error("--output: " + table + " cannot be written");
    std::fprintf(csv, "time_s,kinetic_J,potential_J,total_J\n");
    const double start_energy = system.energy(state);
    const double allowance = energy_allowance(system, state);
    double highest = start_energy;
    const auto start = std::chrono::steady_clock::now();
    std::string trouble;
    int frame = 0;
    for (; frame <= frames; ++frame) {
        if (frame > 0) {
            const auto report = stepper(state, h, substeps);
            if (!report) {
                trouble = std::string(describe(report.status));
                if (report.where >= 0) trouble += ", particle " + std::to_string(report.where);
                break;
            }
        }
        const double kinetic = system.kinetic_energy(state);
        const double potential = system.potential_energy(state);
        highest = std::max(highest, kinetic + potential);
        std::fprintf(csv, "%.9g,%.9g,%.9g,%.9g\n", state.time, kinetic, potential,
                     kinetic + potential);
        if (!(kinetic + potential <= start_energy + allowance)) {  // or it is NaN
            char text[96];
            std::snprintf(text, sizeof text, "the energy rose from %.3g J to %.3g J", start_energy,
                          kinetic + potential);
            trouble = text;
            break;
        }
        if (!taut::write_obj(frame_path(options.output, frame), state.x, scene.faces)) {
            std::fclose(csv);
            throw std::runtime_error("--output: " + frame_path(options.output, frame) +
                                     " cannot be written");
        }
        if (!options.quiet && frame % std::max(1, frames / 10) == 0) {
            std::fprintf(stderr, "%7.3f of %.3f s, energy %.4g J\n", state.time, options.duration,
                         kinetic + potential);
        }
    }
    const bool written = std::ferror(csv) == 0;
    if (std::fclose(csv) != 0 || !written)
        throw std::runtime_error("--output: " + table + " cannot be written");
    warn_of_old_frames(options.output, frame);
    if (!trouble.empty()) {
        std::fprintf(
            stderr,
            "drape: the simulation diverged in the frame after %.4g s: %s.\n"
            "The step %.4e s is too large for this scene and method; stability_report says "
            "which steps are safe.\n",
            state.time, trouble.c_str(), h);
        return diverged;
    }
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf(
        "%.4g s simulated in %.3g s; highest energy %.3e J above the start\n"
        "%s/frame_*.obj (in Blender: import one after another, or an OBJ sequence add-on), %s\n",
        state.time, seconds, highest - start_energy, options.output.c_str(), table.c_str());
    return 0;
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app{"Simulates a cloth and writes an OBJ sequence. Exit code 3: the state diverged."};
    options.scene.add_to(app);
    app.add_option("--method", options.method, "symplectic, verlet, explicit or implicit")
        ->check(CLI::IsMember({"symplectic", "verlet", "explicit", "implicit"}))
        ->capture_default_str();
    app.add_option(
           "--step", options.step,
           "largest time step, s (default: 0.95 of the any-pose limit; implicit: one frame)")
        ->check(example::positive());
    app.add_option("--duration", options.duration, "simulated time, s")
        ->check(example::positive())
        ->capture_default_str();
    app.add_option("--frame-rate", options.frame_rate, "frames written per simulated second")
        ->check(example::positive())
        ->capture_default_str();
    app.add_option("--output", options.output, "folder for the frames and energy.csv")
        ->capture_default_str();
    app.add_flag("--quiet", options.quiet, "no progress line");
    CLI11_PARSE(app, argc, argv)
    if (!options.scene.given()) throw std::runtime_error("name a mesh or --scene (see --help)");
    return simulate(options, example::make_scene(options.scene));
}

}  // namespace

int main(int argc, char** argv) {
    return example::guarded_main("drape", [&] { return run(argc, argv); });
}
