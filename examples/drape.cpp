// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Simulates a cloth under gravity, by default with a guard, and writes an OBJ or PLY sequence, the
// energy over time, and on request a point cache.

#include <chrono>
#include <cstdio>
#include <string>

#include "common/main.hpp"
#include "common/number.hpp"
#include "common/progress.hpp"
#include "drape/record.hpp"
#include "drape/saved_state.hpp"
#include "drape/stepping.hpp"

namespace {

using drape::Cloth;
using drape::Options;
using drape::Plan;
using drape::SavedState;
using drape::State;

constexpr int diverged = 3;     // exit code
constexpr double silence = 10;  // s, the longest

/// The chosen integrator, with or without its guard.
drape::Advance make_motion(const Options& options, const drape::Scene& scene) {
    const std::string& chosen = options.integrator;
    const drape::Step step =
        options.implicit()
            ? drape::implicit_step(scene.cloth, chosen, options.solver, options.tolerance)
            : drape::explicit_step(scene.cloth, chosen);
    if (!options.guard) return drape::by_steps(scene, step);
    const taut::Method like = options.implicit()          ? taut::Method::implicit_euler
                              : chosen == "energy_stable" ? taut::Method::energy_stable_euler
                                                          : taut::Method::symplectic_euler;
    return drape::by_guard(scene, drape::guarded(scene.cloth, step, like, scene.plan.h));
}

/// What became of a run.
struct Outcome {
    std::string trouble;
    double risen = 0;    // highest energy above that at the start, J
    double kinetic = 0;  // the largest, J
    int trimmed = 0;     // frames
    int again = 0;
};

/// A rise of the energy that no fall of the cloth by a hundred times its own size can explain, J;
/// without gravity, no motion by a thousandth of its size in a second.
double energy_allowance(const Cloth& cloth, const State& state) {
    double mass = 0;
    for (taut::Index i = 0; i < cloth.size(); ++i) mass += cloth.mass(i);
    const double size = drape::extent(state);
    return 100 * mass * cloth.gravity().norm() * size + 1e-6 * mass * size * size;
}

/// Frames until the end or the first that went wrong. `run` is where they begin, and then where
/// they ended.
Outcome run_frames(const Options& options, const Cloth& cloth, const Plan& plan,
                   const drape::Obstacle& obstacle, drape::Record& record, SavedState& run) {
    const auto advance = make_motion(options, {cloth, obstacle, plan});
    const double allowance = energy_allowance(cloth, cloth.initial_state());
    const auto say = example::say_on_stderr("drape");
    example::Progress progress(silence, options.quiet ? example::Progress::Say() : say);
    State& state = run.state;
    const auto first = options.resume ? run.frame + 1 : 0;
    Outcome outcome;
    for (taut::Index frame = first; frame <= plan.frames; ++frame) {
        progress.at("frame " + std::to_string(frame) + " of " + std::to_string(plan.frames));
        if (frame > 0) {
            const drape::Advanced advanced = advance(state);
            outcome.trouble = advanced.trouble;
            if (!outcome.trouble.empty()) break;
            outcome.trimmed += advanced.taken == taut::Taken::trimmed;
            outcome.again += advanced.taken == taut::Taken::again;
        }
        const double kinetic = cloth.kinetic_energy(state);
        const double potential = cloth.potential_energy(state);
        const double risen = kinetic + potential - run.start_energy;
        if (!(risen <= allowance)) {  // or it is NaN
            record.add_energy(state.time, kinetic, potential);
            char text[96];
            std::snprintf(text, sizeof text, "the energy rose from %.3g J to %.3g J",
                          run.start_energy, kinetic + potential);
            outcome.trouble = text;
            break;
        }
        outcome.risen = std::max(outcome.risen, risen);
        outcome.kinetic = std::max(outcome.kinetic, kinetic);
        record.add(cloth, state, kinetic, potential);
        run.frame = frame;
        save(options.state_path(), cloth, run);
        if (!options.quiet && frame % std::max(1, plan.frames / 10) == 0) {
            std::fprintf(stderr, "%7.3f of %.3f s, energy %.4g J\n", state.time, options.duration,
                         kinetic + potential);
        }
    }
    return outcome;
}

void print_start(const Options& options, const example::Scene& scene, const Plan& plan,
                 const drape::Obstacle& obstacle) {
    std::printf("%s, law %s\n%s\n", example::describe(scene).c_str(), options.law.c_str(),
                example::describe_space(scene).c_str());
    if (obstacle) std::printf("%s\n", obstacle.description().c_str());
    std::printf("%s%s steps of %s%s s, %lld for each of %d frames of %.4g s\n",
                options.integrator.c_str(), options.guard ? ", guarded" : "",
                options.guard ? "at most " : "", example::rounded_down(plan.h, 5).c_str(),
                static_cast<long long>(plan.steps), plan.frames, plan.frame);
    if (plan.shortened) {
        std::printf("not the %g s of --step: the guard's steps are proved at any pose\n",
                    options.step);
    }
    const bool undamped = options.scene.d0 == 0 && options.scene.alpha == 0;
    if (undamped && !options.implicit()) {
        std::printf("undamped: it swings on and on (--d0, --alpha)\n");
    }
}

/// The end of a sentence that says which step is too large.
const char* cure(const Options& options) {
    if (options.guard) return "";
    if (!options.implicit()) {
        return "; stability_report says which steps are safe, and --guard takes such frames again";
    }
    if (options.integrator == "newton" || options.integrator == "projective") {
        return "; --guard takes such frames again";
    }
    return ", which makes one linearised solve of it; --integrator newton solves the step itself, "
           "and --guard takes such frames again";
}

/// Where a run begins: at rest, or where the one before it ended.
SavedState begin(const Options& options, const Cloth& cloth) {
    if (options.resume) return drape::restore(options.state_path(), cloth);
    SavedState run;
    run.state = cloth.initial_state();
    run.start_energy = cloth.energy(run.state);
    return run;
}

int simulate(const Options& options) {
    const auto scene = example::make_scene(options.scene);
    const Cloth cloth = make_cloth(options, scene);
    SavedState run = begin(options, cloth);
    State& state = run.state;
    const Plan plan = make_plan(options, cloth);
    if (options.resume) require_same(run, options, plan.frame);
    if (options.resume && run.frame >= plan.frames) {
        throw std::runtime_error("--resume: " + options.output + " has all of its " +
                                 std::to_string(plan.frames) +
                                 " frames; a larger --duration asks for more");
    }
    const drape::Obstacle obstacle(options, cloth, cloth.initial_state());
    const auto first = options.resume ? static_cast<int>(run.frame) + 1 : 0;
    drape::Record record(options, scene, first, plan.frames);
    run.frame_length = plan.frame;
    run.settings = options.settings;
    print_start(options, scene, plan, obstacle);
    if (options.resume)
        std::printf("goes on after frame %lld, %.4g s\n", static_cast<long long>(run.frame),
                    state.time);

    const double begun = state.time;
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = run_frames(options, cloth, plan, obstacle, record, run);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    record.close();
    if (!outcome.trouble.empty()) {
        std::fprintf(stderr,
                     "drape: the simulation diverged in the frame after %.4g s: %s.\n"
                     "The step %.4e s is too large for this scene and integrator%s.\n",
                     state.time, outcome.trouble.c_str(), plan.h, cure(options));
        return diverged;
    }
    std::printf(
        "%.4g s simulated in %.3g s; highest energy %.3e J above the start, largest kinetic energy "
        "%.3e J\n",
        state.time - begun, elapsed.count(), outcome.risen, outcome.kinetic);
    if (options.guard) {
        std::printf("the guard trimmed %d frames and took %d again\n", outcome.trimmed,
                    outcome.again);
    }
    std::printf("%s/frame_*.%s, %s\n", options.output.c_str(), options.format.c_str(),
                record.energy_path().c_str());
    if (!options.cache.empty()) {
        std::printf(
            "%s: in Blender, import %s/frame_00000.%s, add the modifier Mesh Cache, format "
            "PC2\n",
            options.cache.c_str(), options.output.c_str(), options.format.c_str());
    }
    return 0;
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app{
        "Simulates a cloth and writes an OBJ or PLY sequence, for Blender a point cache too.\n"
        "Exit code 3: the state diverged.\n\n"
        "  drape hanging_cloth --cache cloth.pc2\n"
        "  drape hanging_cloth --free --collide sphere --law buckling --integrator implicit\n"
        "  drape shirt.obj --pin-top 2% --integrator bdf2 --guard\n"
        "  drape shirt.obj --pin-top 2% --integrator bdf2 --guard --duration 5 --resume\n"};
    example::add_version(app, "drape");
    options.add_to(app);
    CLI11_PARSE(app, argc, argv)
    options.settle(app);
    options.check();
    return simulate(options);
}

}  // namespace

int main(int argc, char** argv) {
    return example::guarded_main("drape", [&] { return run(argc, argv); });
}
