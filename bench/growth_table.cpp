// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Where one core ends: how the time of a step grows with springs and threads, and from how many
// ranks on LAMMPS is faster. Prints Markdown; bench/results/growth.md says how to read it.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <taut/taut.hpp>
#include <thread>
#include <vector>

#include "lammps_run.hpp"
#include "measure.hpp"
#include "memory.hpp"

namespace {

using System = taut::SpringSystem<double, 3>;
using Stepper = taut::VelocityVerlet<System>;  // LAMMPS's own method
using taut::Index;
constexpr int runs = 5;
constexpr double cap = 6e9;               // bytes of a scene
constexpr double bytes_per_spring = 200;  // measured 172, when limits are asked; LAMMPS takes 85
#ifdef _OPENMP
constexpr bool has_threads = true;
#else
constexpr bool has_threads = false;
#endif

/// ns a spring and step for each of the counts; 0: not run.
using Times = std::vector<double>;

struct Growth {
    double springs = 1e7;              // of the largest scene
    double updates = 1e8;              // springs times steps of a run
    std::vector<int> counts;           // of threads and of ranks
    std::string folder;                // for LAMMPS; empty: there is none
    bool failed = false;               // whether its log may tell why
    std::vector<std::string> missing;  // sentences
};

/// 1, 2, 4, ..., and all processors of this machine.
std::vector<int> counts_here() {
    const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::vector<int> counts;
    for (int count = 1; count < all; count *= 2) counts.push_back(count);
    counts.push_back(all);
    return counts;
}

System cloth_of(double springs) {
    taut::ClothOptions options;
    options.rows = options.columns = std::lround(std::sqrt(springs / 6));
    return taut::hanging_cloth<double>(options);
}

/// The counts take turns, so that a busy minute meets them all.
Times taut_times(const Growth& growth, const System& system, const System::State& start,
                 Index steps) {
    const double h = 0.5 * taut::any_pose_limit(system).certified;
    std::vector<Stepper> steppers;
    for (const int threads : growth.counts) {
        if (threads == 1 || has_threads) steppers.emplace_back(system, Stepper::Options{threads});
    }
    std::vector<System::State> states(steppers.size(), start);
    std::vector<bench::Stopwatch> watches(growth.counts.size());
    const auto take = [&](std::size_t i, Index count) {
        if (!steppers[i].step(states[i], h, count)) std::abort();
    };
    for (std::size_t i = 0; i < steppers.size(); ++i) take(i, 2);  // plans are made
    for (int run = 0; run < runs; ++run) {
        for (std::size_t i = 0; i < steppers.size(); ++i) watches[i].run([&] { take(i, steps); });
    }
    for (const auto& state : states) {
        if (state.x != states[0].x) std::abort();  // any number of threads gives the same bits
    }
    Times times;
    for (const auto& watch : watches) times.push_back(1e6 * watch.times().least);
    return times;
}

/// Of the scene in growth.folder.
Times lammps_times(Growth& growth) {
    std::vector<std::vector<double>> seconds(growth.counts.size());
    std::size_t able = seconds.size();  // more ranks than fail are not tried
    for (int run = 0; run < runs; ++run) {
        for (std::size_t i = 0; i < able; ++i) {
            if (bench::lammps("growth_table", growth.folder, growth.counts[i])) {
                seconds[i].push_back(bench::loop_time(growth.folder));
            } else {
                growth.missing.push_back("lmp failed, number of ranks: " +
                                         std::to_string(growth.counts[i]));
                growth.failed = true;
                able = i;
            }
        }
    }
    Times times;
    for (const auto& each : seconds) times.push_back(1e9 * bench::summary(each).least);
    return times;
}

void put(double value, const char* format = " %.2f |") {
    value > 0 ? std::printf(format, value) : std::printf(" - |");
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

void put_times(const Times& times, double updates) {
    for (std::size_t i = 0; i < times.size(); ++i) {
        put(times[i] / updates);
        if (i > 0) put(ratio(times[0], times[i]));
    }
}

void row(Growth& growth, double about, bool is_lattice) {
    Times ours, theirs(growth.counts.size());
    Index springs = 0, steps = 0;
    bool written = false;
    {
        const System system = is_lattice ? bench::lattice_of(about, true) : cloth_of(about);
        springs = system.spring_count();
        steps = std::max<Index>(4, std::lround(growth.updates / double(springs)));
        auto state = system.initial_state();
        for (Index i = 0; is_lattice && i < state.v.size(); ++i) {  // a cloth falls by itself
            state.v.data()[i] = 0.01 * std::sin(double(i));
        }
        ours = taut_times(growth, system, state, steps);
        if (is_lattice && !growth.folder.empty()) {
            written = bool(
                taut::write_lammps(growth.folder, system, state, bench::lammps_steps_alone(steps)));
            if (!written) growth.missing.push_back("LAMMPS: its files cannot be written");
        }
    }  // LAMMPS has the memory for itself
    if (written) theirs = lammps_times(growth);
    std::printf("| %lld |", static_cast<long long>(springs));
    put_times(ours, double(springs) * double(steps));
    if (is_lattice) {
        put_times(theirs, double(springs) * double(steps));
        for (const double time : ours) put(ratio(theirs[0], time), " %.1f |");
    }
    std::printf("\n");
    std::fflush(stdout);
}

void table(Growth& growth, bool is_lattice) {
    std::string head = "| springs |";
    const auto columns = [&](const std::string& before, const char* after, bool ratios) {
        for (const int count : growth.counts) {
            head += before + std::to_string(count) + after + (count > 1 ? "s |" : " |");
            if (ratios && count > 1) head += " times as fast |";
        }
    };
    columns(" Taut, ", " thread", true);
    if (is_lattice) columns(" LAMMPS, ", " rank", true);
    if (is_lattice) columns(" ranks for ", " thread", false);
    std::printf("\n## %s\n\n%s\n|", is_lattice ? "Lattices" : "Hanging cloths", head.c_str());
    for (auto i = std::count(head.begin(), head.end(), '|'); i > 1; --i) std::printf("---|");
    std::printf("\n");
    for (double springs = 1e3; springs < 1.01 * growth.springs; springs *= 10) {
        if (springs * bytes_per_spring < std::min(cap, bench::available_bytes())) {
            row(growth, springs, is_lattice);
        } else {
            growth.missing.push_back(std::to_string(std::lround(springs)) + " springs: memory");
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    Growth growth;
    if (argc > 1) growth.springs = std::atof(argv[1]);
    if (argc > 2) growth.updates = std::atof(argv[2]);
    if (argc > 3 || !(growth.springs >= 1e3) || !(growth.updates > 0)) {
        std::fprintf(stderr, "growth_table [SPRINGS [UPDATES]], of the largest scene and a run\n");
        return 2;
    }
    growth.counts = counts_here();
    const auto folder = std::filesystem::temp_directory_path() / "taut_growth";
    if (bench::has_lammps()) {
        growth.folder = folder.string();
        std::filesystem::create_directories(folder);
    }
    if (growth.folder.empty()) growth.missing.push_back("LAMMPS: no lmp, or no mpirun");
    if (!has_threads) growth.missing.push_back("threads: built without OpenMP");
    double load = -1;  // not known
    (void)getloadavg(&load, 1);
    std::printf("ns a spring and step, least of %d runs; %d processors, load %.1f at the start.\n",
                runs, growth.counts.back(), load);
    table(growth, true);
    table(growth, false);
    for (const auto& what : growth.missing) std::printf("\nNot run: %s.\n", what.c_str());
    if (!growth.failed) std::filesystem::remove_all(folder);
}
