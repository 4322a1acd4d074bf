// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Whose energy rises: explicit steps at shares of the any-pose limit, with and without damping,
// from violent starts. Prints Markdown. What one build counts does not depend on the machine's
// load.
//
//     survival_table [map | recipe | mass | loss] [MESH.obj] [--runs N] [--steps N] [--seed N]
//                    [--share H] [--ahead A] [--scene TEXT] [--law TEXT] [--csv FILE]
//
// `map` walks over shares and dampings; `recipe` takes one of each, many times, and exits with 1 if
// a run fails; `mass` is a finer map of one mass alone; `loss` says what the recipe takes out of an
// undisturbed cloth. Run i of a row starts from seed + i, so that `--scene … --law … --seed N
// --runs 1` repeats a run that failed.

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <taut/taut.hpp>
#include <utility>
#include <vector>

#include "../examples/common/mesh_file.hpp"
#include "survival/loss.hpp"
#include "survival/run.hpp"
#include "survival/scenes.hpp"

namespace {

using namespace bench::survival;
using taut::Method;

struct Options {
    std::string job = "map", mesh, scene, law, csv;
    int runs = 0;     // 0: of the job
    Index steps = 0;  // 0: of the job
    std::uint64_t seed = 1;
    double share = taut::recipe.safety;              // h / limit
    double ahead = taut::recipe.damping.look_ahead;  // share of h
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "map" || word == "recipe" || word == "mass" || word == "loss") {
            options.job = word;
            continue;
        }
        if (word.rfind("--", 0) != 0) {
            options.mesh = word;
            continue;
        }
        if (++i == argc) throw std::runtime_error(word + " needs a value");
        const char* value = argv[i];
        if (word == "--runs") {
            options.runs = std::atoi(value);
        } else if (word == "--steps") {
            options.steps = std::atol(value);
        } else if (word == "--seed") {
            options.seed = std::strtoull(value, nullptr, 10);
        } else if (word == "--share") {
            options.share = std::atof(value);
        } else if (word == "--ahead") {
            options.ahead = std::atof(value);
        } else if (word == "--scene") {
            options.scene = value;
        } else if (word == "--law") {
            options.law = value;
        } else if (word == "--csv") {
            options.csv = value;
        } else {
            throw std::runtime_error(word + " is unknown");
        }
    }
    return options;
}

/// FNV-1a, so that no two rows draw the same numbers.
std::uint64_t hash(const std::string& text) {
    std::uint64_t bits = 14695981039346656037U;
    for (const char c : text) bits = (bits ^ static_cast<unsigned char>(c)) * 1099511628211U;
    return bits;
}

/// A scene under a law, and what became of it at each setting.
struct Row {
    std::string scene, law;
    Index steps;               // a run
    std::vector<Tally> cells;  // one a setting

    bool is_empty(std::size_t s) const { return cells[s].runs == 0; }
};

/// How much of options.runs a scene gets, and whether it is left to the methods of every kind.
struct Effort {
    double runs;
    bool every_method = false;
    double steps = 1;  // of the map's, where a run takes long
};

/// Scenes × laws. Few runs of what takes long: large scenes, and the laws with buckling springs.
class Sweep {
public:
    /// @param finished  sees each row as soon as its runs are over
    Sweep(Options options, std::vector<Setting> settings, std::function<void(const Row&)> finished)
        : options_(std::move(options)),
          settings_(std::move(settings)),
          finished_(std::move(finished)) {}

    void walk() {
        scene("mass, 1-D", {1, true}, one_mass<1>);
        scene("mass, 2-D", {1, true}, one_mass<2>);
        scene("pendulum, 2-D", {1, true}, pendulum);
        scene("masses of 1 : 10⁶, 2-D", {1, true}, unequal_masses);
        scene("string of 16", {0.5, true}, string);
        cloth_scene("cloth 6 × 6", {0.5, true}, [](Random&) { return cloth(6); });
        scene("soft body 4 × 4 × 4", {0.25, false, 0.2}, soft_body);
        cloth_scene("cloth 16 × 16", {0.15, false, 0.2}, [](Random&) { return cloth(16); });
        cloth_scene("cloth 32 × 32", {0.06, false, 0.2}, [](Random&) { return cloth(32); });
        if (!options_.mesh.empty()) {
            const auto file = example::read_obj(options_.mesh);
            const auto mesh = taut::springs_from_mesh<double>(file.vertices, file.faces);
            cloth_scene("garment", {0.03, false, 0.2}, [&](Random&) { return garment(mesh); });
        }
    }
    const std::vector<Row>& rows() const { return rows_; }
    const std::vector<Setting>& settings() const { return settings_; }
    /// One line a run that ended above its start.
    const std::vector<std::string>& failures() const { return failures_; }

private:
    template <class Make>
    void scene(const char* name, const Effort& effort, const Make& make) {
        row<AllHookean>(name, effort, make);
        row<AllTensionOnly>(name, effort, make);
        row<AllBuckling>(name, effort, make);
    }
    template <class Make>
    void cloth_scene(const char* name, const Effort& effort, const Make& make) {
        scene(name, effort, make);
        row<ChoiKo>(name, effort, make);
    }
    template <class Law, class Make>
    void row(const char* name, const Effort& effort, const Make& make) {
        const std::string scene_name = name, law = Law::name;
        if (scene_name.find(options_.scene) == std::string::npos) return;
        if (law.find(options_.law) == std::string::npos) return;
        const double shorter = options_.job == "map" ? effort.steps : 1;
        Row row{name, law, std::lround(shorter * static_cast<double>(options_.steps)),
                std::vector<Tally>(settings_.size())};
        const double weight = effort.runs * Law::weight;
        const int runs = std::max(1, static_cast<int>(std::lround(options_.runs * weight)));
        for (int i = 0; i < runs; ++i) {
            const std::uint64_t seed = options_.seed + static_cast<std::uint64_t>(i);
            Random random(seed ^ hash(row.scene + row.law));
            const auto drawn = make(random);
            const auto start = random_start(drawn, random);
            const auto system = with_law<Law>(drawn);
            const double limit = taut::any_pose_limit(system).certified;
            for (std::size_t s = 0; s < settings_.size(); ++s) {
                const auto& setting = settings_[s];
                if (!effort.every_method && setting.method != Method::symplectic_euler) continue;
                const Run found = run(system, start, setting, limit, row.steps);
                row.cells[s].add(found);
                if (found.end >= End::rose) note(row, seed, setting, found);
            }
        }
        finished_(row);
        rows_.push_back(std::move(row));
    }
    void note(const Row& row, std::uint64_t seed, const Setting& setting, const Run& found) {
        char text[256];
        std::snprintf(text, sizeof text,
                      "%s, %s, seed %" PRIu64 ", %s at %g, %s: %s, peak %.3g, late %.3g",
                      row.scene.c_str(), row.law.c_str(), seed, taut::name(setting.method),
                      setting.share, setting.damping.name().c_str(),
                      found.end == End::blew_up ? "blew up" : "rose", found.peak, found.late);
        failures_.push_back(text);
    }

    Options options_;
    std::vector<Setting> settings_;
    std::function<void(const Row&)> finished_;
    std::vector<Row> rows_;
    std::vector<std::string> failures_;
};

// ---- the map ----

std::vector<Setting> map_settings() {
    std::vector<Setting> settings;
    const auto add = [&](Method method, Damping damping) {
        for (const double share : {0.5, 0.6, 0.7, 0.8, 0.9, 0.95}) {
            const Setting setting{method, share, damping};
            if (setting.is_linearly_stable()) settings.push_back(setting);
        }
    };
    const Damping none;
    add(Method::symplectic_euler, none);
    for (const double ahead : {0.1, 0.25, 0.4, 0.5}) {
        add(Method::symplectic_euler, {DampingKind::look_ahead, ahead});
    }
    add(Method::symplectic_euler, {DampingKind::rayleigh, 0.25});
    add(Method::symplectic_euler, {DampingKind::graph, 1});
    add(Method::velocity_verlet, none);
    add(Method::velocity_verlet, {DampingKind::look_ahead, 0.4});
    add(Method::explicit_euler, {DampingKind::look_ahead, 1.5});
    return settings;
}

void print_map(const Sweep& sweep) {
    std::printf(
        "## Survival over step and damping\n\n"
        "h in shares of `any_pose_limit(system).certified` without damping. A cell is a / b, in "
        "%%: "
        "a of the runs blew up (not finite, or ten times as much energy above the start as kinetic "
        "energy, elastic energy and weight times extent at the start), b ended above their start "
        "or blew up: by more than 1 %% of the largest kinetic energy seen, in the mean of the last "
        "ten looks, one every hundred steps. No cell where the linearised step is unstable "
        "already.\n");
    const auto& settings = sweep.settings();
    for (std::size_t first = 0, last; first < settings.size(); first = last) {
        const auto& head = settings[first];
        last = first;
        std::string columns, rule;
        while (last < settings.size() && settings[last].method == head.method &&
               settings[last].damping.name() == head.damping.name()) {
            char text[32];
            std::snprintf(text, sizeof text, " %g |", settings[last++].share);
            columns += text;
            rule += "---|";
        }
        std::printf("\n### %s, %s\n\n| scene | law | runs | steps |%s\n|---|---|---|---|%s\n",
                    taut::name(head.method), head.damping.name().c_str(), columns.c_str(),
                    rule.c_str());
        for (const auto& row : sweep.rows()) {
            if (row.is_empty(first)) continue;
            std::printf("| %s | %s | %d | %ld |", row.scene.c_str(), row.law.c_str(),
                        row.cells[first].runs, static_cast<long>(row.steps));
            for (std::size_t s = first; s < last; ++s) {
                const auto& cell = row.cells[s];
                const double percent = 100.0 / cell.runs;
                std::printf(" %.0f / %.0f |", percent * cell.blew_up, percent * cell.failed());
            }
            std::printf("\n");
        }
    }
}

void write_csv(const Sweep& sweep, const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (file == nullptr) throw std::runtime_error(path + " cannot be written");
    std::fprintf(file, "scene,law,method,damping,h_over_limit,runs,steps,swung,rose,blew_up\n");
    for (const auto& row : sweep.rows()) {
        for (std::size_t s = 0; s < sweep.settings().size(); ++s) {
            if (row.is_empty(s)) continue;
            const auto& [method, share, damping] = sweep.settings()[s];
            const auto& cell = row.cells[s];
            std::fprintf(file, "\"%s\",%s,%s,%s,%g,%d,%ld,%d,%d,%d\n", row.scene.c_str(),
                         row.law.c_str(), taut::name(method), damping.name().c_str(), share,
                         cell.runs, static_cast<long>(row.steps), cell.swung, cell.rose,
                         cell.blew_up);
        }
    }
    if (std::fclose(file) != 0) throw std::runtime_error(path + " cannot be written");
}

// ---- one mass ----

template <class Law>
void print_mass(const Options& options) {
    const double shares[] = {0, 0.05, 0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5};
    std::printf("\n### %s\n\n| h / limit \\ look ahead / h |", Law::name);
    for (const double ahead : shares) std::printf(" %g |", ahead);
    std::printf("\n|---|");
    for (std::size_t i = 0; i < std::size(shares); ++i) std::printf("---|");
    std::printf("\n");
    for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95}) {
        std::printf("| %g |", share);
        for (const double ahead : shares) {
            const auto kind = ahead > 0 ? DampingKind::look_ahead : DampingKind::none;
            const Setting setting{Method::symplectic_euler, share, {kind, ahead}};
            if (!setting.is_linearly_stable()) {
                std::printf(" – |");
                continue;
            }
            Random random(options.seed);
            const auto drawn = one_mass<1>(random);
            const auto system = with_law<Law>(drawn);
            const double limit = taut::any_pose_limit(system).certified;
            Tally tally;
            for (int i = 0; i < options.runs; ++i) {
                const auto start = random_start(drawn, random);
                tally.add(run(system, start, setting, limit, options.steps));
            }
            std::printf(" %.3g / %.3g |", 100.0 * tally.blew_up / tally.runs,
                        100.0 * tally.failed() / tally.runs);
        }
        std::printf("\n");
        std::fflush(stdout);
    }
}

// ---- the recipe ----

void print_recipe_line(const char* scene, const char* law, const Tally& tally) {
    std::printf("| %s | %s | %d | %d | %d | %d | %.3g |\n", scene, law, tally.runs, tally.swung,
                tally.rose, tally.blew_up, tally.highest);
    std::fflush(stdout);
}

/// @returns whether no run failed
bool print_recipe(const Options& options) {
    const auto kind = options.ahead > 0 ? DampingKind::look_ahead : DampingKind::none;
    const Setting setting{Method::symplectic_euler, options.share, {kind, options.ahead}};
    std::printf(
        "## The recipe: symplectic Euler at %g of the any-pose limit, %s, %ld steps a run\n\n"
        "Swung: was above its start by more than 1 %% of the largest kinetic energy seen at some "
        "look, and no more at the end. Rose, blew up: as in the map. Highest: energy above the "
        "start over the largest kinetic energy, the worst look of any run.\n\n"
        "| scene | law | runs | swung | rose | blew up | highest "
        "|\n|---|---|---|---|---|---|---|\n",
        setting.share, setting.damping.name().c_str(), static_cast<long>(options.steps));
    Tally all;
    Sweep sweep(options, {setting}, [&](const Row& row) {
        print_recipe_line(row.scene.c_str(), row.law.c_str(), row.cells.front());
        all.add(row.cells.front());
    });
    sweep.walk();
    print_recipe_line("all", "all", all);
    std::printf("\n%d of %d runs failed (rose or blew up).", all.failed(), all.runs);
    if (all.failed() == 0) {
        std::printf(" With 95 %% confidence fewer than %.3g %% of such runs do (3/N).",
                    100 * 3.0 / all.runs);
    }
    std::printf("\n");
    for (const auto& failure : sweep.failures()) std::printf("\n    %s\n", failure.c_str());
    return all.failed() == 0;
}

}  // namespace

int main(int argc, char** argv) try {
    auto options = parse(argc, argv);
    if (options.job == "loss") {
        print_losses();
        return 0;
    }
    if (options.job == "mass") {
        if (options.runs == 0) options.runs = 400;
        if (options.steps == 0) options.steps = 5000;
        std::printf(
            "## One mass in one dimension, %d runs of %ld steps\n\n"
            "In %% of the runs: blew up / ended above their start or blew up, as in the map.\n",
            options.runs, static_cast<long>(options.steps));
        print_mass<AllHookean>(options);
        print_mass<AllTensionOnly>(options);
        return 0;
    }
    const bool map = options.job == "map";
    if (options.runs == 0) options.runs = map ? 20 : 170;
    if (options.steps == 0) options.steps = 100000;
    if (map) {
        Sweep sweep(options, map_settings(), [](const Row& row) {
            std::fprintf(stderr, "%s, %s\n", row.scene.c_str(), row.law.c_str());
        });
        sweep.walk();
        print_map(sweep);
        if (!options.csv.empty()) write_csv(sweep, options.csv);
        return 0;
    }
    return print_recipe(options) ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "survival_table: %s\n", error.what());
    return 2;
}
