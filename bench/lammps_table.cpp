// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Networks for LAMMPS: what certifying and writing 1e5, 1e6 and 1e7 springs cost, a lattice at both
// edges of its limit in LAMMPS itself, and LAMMPS on one rank and two. docs/lammps.md has a run.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <taut/lammps/lammps.hpp>
#include <taut/lammps/lammps_dump.hpp>
#include <taut/proof/bracket.hpp>

#include "../examples/common/number.hpp"
#include "lammps_run.hpp"
#include "measure.hpp"

#include <sys/resource.h>

namespace {

using System = taut::SpringSystem<double, 3>;
using taut::Index;

/// So far, of this process.
double peak_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
}

/// One row, measured in a process of its own.
int scale_row(double springs, bool diagonals, const std::string& folder) {
    const System system = bench::lattice_of(springs, diagonals);
    const auto state = system.initial_state();
    const double scene = peak_megabytes();
    double start = bench::now(bench::process_time);
    const auto limit = taut::any_pose_bracket(system);
    const double certify = bench::now(bench::process_time) - start;
    const double certified = peak_megabytes();
    start = bench::now(bench::process_time);
    const auto report = taut::write_lammps(folder, system, state);
    const double write = bench::now(bench::process_time) - start;
    if (!report) {
        std::fprintf(stderr, "lammps_table: %s\n", report.file.message().c_str());
        return 1;
    }
    const double bytes = static_cast<double>(std::filesystem::file_size(folder + "/taut.data"));
    std::printf(
        "| %lld | %lld | %.0f MB | %.2f s | %.0f MB | %.1f %% | %.2f s | %.0f MB | %.0f MB |\n",
        static_cast<long long>(system.spring_count()), static_cast<long long>(system.size()), scene,
        certify / 1e3, certified, 100 * limit.certified / limit.refuted, write / 1e3,
        peak_megabytes() - certified, bytes / 1e6);
    return 0;
}

int scale(const std::string& program, const std::string& folder) {
    std::printf(
        "Processor time; peaks are of the whole process. Writing certifies again.\n\n"
        "| springs | particles | scene | certify | peak | certified/refuted | write | more "
        "memory | file |\n|---|---|---|---|---|---|---|---|---|\n");
    std::fflush(stdout);
    for (const char* diagonals : {"9", "3"}) {
        for (const char* springs : {"1e5", "1e6", "1e7"}) {
            const std::string row =
                "'" + program + "' row " + springs + " " + diagonals + " '" + folder + "'";
            if (std::system(row.c_str()) != 0) return 1;
        }
    }
    return 0;
}

/// A lattice at rest, kicked by 1e-6 of its size along its limiting mode.
int limit(const std::string& folder, Index edge, Index steps) {
    const auto lattice = taut::lattice<double>({{edge, edge, edge}});
    const auto rest = lattice.initial_state();
    const taut::Stability<double> stability(lattice, rest);
    const auto bracket = taut::bracket(stability, taut::Method::velocity_verlet);
    const auto mode = taut::limiting_mode(stability);
    const double kick = 1e-6 * rest.x.maxCoeff();
    auto state = rest;
    Eigen::Map<Eigen::VectorXd>(state.x.data(), state.x.size()) +=
        kick / mode.shape.cwiseAbs().maxCoeff() * mode.shape;
    std::printf(
        "lattice of %lld^3 particles, %lld springs; certified %s s, refuted %s s\n\n"
        "| step | steps | largest displacement / kick |\n|---|---|---|\n",
        static_cast<long long>(edge), static_cast<long long>(lattice.spring_count()),
        example::rounded_down(bracket.certified, 7).c_str(),
        example::rounded_up(bracket.refuted, 7).c_str());
    std::fflush(stdout);
    for (const bool below : {true, false}) {
        taut::LammpsOptions options;
        options.step = below ? 0.99 * bracket.certified : 1.02 * bracket.refuted;
        options.steps = below ? steps : 20;
        options.every = below ? std::max<Index>(1, steps / 100) + 1 : 20;
        options.velocities = false;
        if (!taut::write_lammps(folder, lattice, state, options) ||
            !bench::lammps("lammps_table", folder, 1))
            return 1;
        taut::LammpsDump<double, 3> dump(folder + "/taut.dump", lattice.size());
        auto frame = rest;
        double most = 0;
        while (auto report = dump.read(frame))
            most = std::max(most, (frame.x - rest.x).cwiseAbs().maxCoeff());
        std::printf("| %s | %lld | %.3g |\n", below ? "0.99 certified" : "1.02 refuted",
                    static_cast<long long>(options.steps), most / kick);
        std::fflush(stdout);
    }
    return 0;
}

int ranks(const std::string& folder, double springs, Index steps) {
    const System lattice = bench::lattice_of(springs, true);
    const auto options = bench::lammps_steps_alone(steps);
    if (!taut::write_lammps(folder, lattice, lattice.initial_state(), options)) return 1;
    std::printf(
        "lattice of %lld springs, %lld steps; wall time, the least of three\n\n"
        "| ranks | time | efficiency |\n|---|---|---|\n",
        static_cast<long long>(lattice.spring_count()), static_cast<long long>(steps));
    double alone = 0;
    for (const int count : {1, 2}) {
        double least = 0;
        for (int run = 0; run < 3; ++run) {
            if (!bench::lammps("lammps_table", folder, count)) return 1;
            const double time = bench::loop_time(folder);
            least = run == 0 ? time : std::min(least, time);
        }
        if (count == 1) alone = least;
        std::printf("| %d | %.2f s | %.0f %% |\n", count, least, 100 * alone / (count * least));
        std::fflush(stdout);
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "scale";
    const auto number = [&](int i, double otherwise) {
        return argc > i ? std::atof(argv[i]) : otherwise;
    };
    if (what == "row" && argc == 5) return scale_row(number(2, 0), number(3, 0) > 3, argv[4]);
    const std::string folder = (std::filesystem::temp_directory_path() / "taut_lammps").string();
    std::filesystem::create_directories(folder);
    int code = 2;
    if (what == "scale") code = scale(argv[0], folder);
    if (what == "limit")
        code = limit(folder, std::lround(number(2, 20)), std::lround(number(3, 1e5)));
    if (what == "ranks") code = ranks(folder, number(2, 1e6), std::lround(number(3, 100)));
    if (code == 2)
        std::fprintf(stderr,
                     "lammps_table [scale | limit [EDGE [STEPS]] | ranks [SPRINGS [STEPS]]]\n");
    std::filesystem::remove_all(folder);
    return code;
}
