// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// How few particles will do: what resolve() answers for goals of 1, 3, 5 and 10 %, and how far that
// is from the scene itself. Prints Markdown; exits with 1 if a goal that was said to be met was
// not. Arguments: seconds of motion, then OBJ files, which hang by the highest 2 % of their
// vertices.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/mesh.hpp>
#include <taut/resolution/resolution.hpp>
#include <taut/proof/energy_limit.hpp>
#include <vector>

#include "../examples/common/mesh_file.hpp"
#include "../examples/common/pins.hpp"
#include "mesh_in.hpp"

namespace {

using taut::Index;
using System = taut::SpringSystem<double, 3>;
using Path = std::vector<taut::Points<double, 3>>;

struct Scene {
    std::string name;
    System system;
};

Scene mesh(const std::string& path) {
    const auto file = example::read_obj(path);
    auto springs = taut::springs_from_mesh<double>(file.vertices, file.faces);
    springs.system.set_gravity({0, -9.81, 0});
    const auto is_used = [&](Index v) { return springs.particle_of_vertex[v] >= 0; };
    for (const Index v :
         example::highest_vertices(file.vertices, Eigen::Vector3d::UnitY(), 0.02, is_used))
        springs.system.pin(springs.particle_of_vertex[v]);
    return {bench::file_name(path), std::move(springs.system)};
}

Scene cloth(Index side) {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    return {"hanging_cloth " + std::to_string(side), taut::hanging_cloth<double>(options)};
}

/// Positions at 31 even times, by steps that cannot gain energy.
Path motion(const System& system, System::State state, double duration) {
    constexpr int samples = 30;
    const double interval = duration / samples;
    const double most = taut::energy_limit(system).certified;
    const double steps = std::ceil(interval / most);
    taut::EnergyStableEuler<System> stepper(system);
    Path path{state.x};
    for (int s = 0; s < samples; ++s) {
        if (!stepper.step(state, interval / steps, static_cast<Index>(steps))) std::exit(2);
        path.push_back(state.x);
    }
    return path;
}

/// Root mean square over particles at the worst time, of the scene's size.
double true_error(const Scene& scene, const Path& fine, const taut::Coarsening<System>& coarsening,
                  double duration, double size) {
    const auto few =
        motion(coarsening.system, coarsening.restricted(scene.system.initial_state()), duration);
    double worst = 0;
    for (std::size_t s = 0; s < fine.size(); ++s) {
        const taut::Points<double, 3> apart =
            fine[s] - fine[0] - coarsening.lifted(few[s] - few[0]);
        worst = std::max(worst, std::sqrt(apart.colwise().squaredNorm().mean()));
    }
    return worst / size;
}

struct Tally {
    int promises = 0, broken = 0, estimates = 0, within_two = 0;
};

void row(const Scene& scene, const Path& fine, double duration, double goal, Tally& tally) {
    const auto state = scene.system.initial_state();
    const double begin = taut::cpu_seconds();
    const auto found = taut::resolve(scene.system, state, duration, goal);
    const double spent = taut::cpu_seconds() - begin;
    std::printf("| %s | %g %% | %s | ", scene.name.c_str(), 100 * goal, name(found.outcome));
    if (found.coarsening) {
        const auto& level = found.levels[static_cast<std::size_t>(found.chosen)];
        const double truth = true_error(scene, fine, *found.coarsening, duration, found.size);
        std::printf("%lld of %lld | %.2g %% | %.2g %% | %s | ",
                    static_cast<long long>(level.particles),
                    static_cast<long long>(scene.system.size()), 100 * level.error, 100 * truth,
                    taut::tradeoff_detail::ratio(found.cheaper()).c_str());
        ++tally.promises;
        tally.broken += truth > goal;
    } else {
        std::printf(" | | | | ");
    }
    const double finest = found.levels.empty() ? 0 : found.levels.back().cost;
    std::printf("%.2g | %.3g | %.2f s |\n", finest > 0 ? found.search_cost / finest : 0,
                found.search_cost / found.fine_cost, spent);
    for (const auto& level : found.levels) {
        if (!std::isfinite(level.error)) continue;
        const double truth = true_error(scene, fine, taut::coarsen(scene.system, level.particles),
                                        duration, found.size);
        ++tally.estimates;
        tally.within_two += level.error <= 2 * truth && truth <= 2 * level.error;
    }
}

void time_coarsening() {
    std::printf("\n| particles | springs | count | coarsen, processor time |\n|---|---|---|---|\n");
    const Scene scene = cloth(317);
    for (const Index count : {100, 1000, 10'000, 25'000}) {
        double least = 1e9;
        for (int repeat = 0; repeat < 5; ++repeat) {
            const double begin = taut::cpu_seconds();
            const auto coarse = taut::coarsen(scene.system, count);
            least = std::min(least, taut::cpu_seconds() - begin);
        }
        std::printf("| %lld | %lld | %lld | %.2f s |\n",
                    static_cast<long long>(scene.system.size()),
                    static_cast<long long>(scene.system.spring_count()),
                    static_cast<long long>(count), least);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const double duration = argc > 1 ? std::atof(argv[1]) : 0.5;
    std::vector<Scene> scenes{cloth(64), cloth(101), cloth(128)};
    for (int i = 2; i < argc; ++i) scenes.push_back(mesh(argv[i]));
    std::printf("Motion of %g s\n\n", duration);
    std::printf(
        "| scene | goal | outcome | particles | error, estimated | error, true | times cheaper | "
        "search, of its finest run | search, of the scene's | search, time |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    Tally tally;
    for (const Scene& scene : scenes) {
        const Path fine = motion(scene.system, scene.system.initial_state(), duration);
        for (const double goal : {0.01, 0.03, 0.05, 0.1}) row(scene, fine, duration, goal, tally);
    }
    std::printf(
        "\n%d goals said to be met, %d of them missed; %d of %d estimates within a factor "
        "of 2 of the true error.\n",
        tally.promises, tally.broken, tally.within_two, tally.estimates);
    time_coarsening();
    return tally.broken == 0 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "resolution_table: %s\n", error.what());
    return 1;
}
