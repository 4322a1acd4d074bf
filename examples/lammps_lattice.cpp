// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The worked case of docs/lammps.md: a bar of a cubic lattice that is stretched by its ends.
// Written for LAMMPS, and what LAMMPS made of it read back.

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <taut/lammps/lammps_dump.hpp>
#include <taut/mesh_files/ply.hpp>
#include <taut/lattice/lattice.hpp>

#include "common/lammps_files.hpp"
#include "common/main.hpp"
#include "common/option_checks.hpp"

namespace {

using taut::Index;
using System = taut::SpringSystem<double, 3>;

constexpr Index steps = 4000;
constexpr Index frames = 5;       // and the start
constexpr double stretch = 0.02;  // at the end
constexpr std::array<Index, 3> particles{41, 9, 9};

/// Both ends are held; the far one shall move.
System make_bar() {
    taut::LatticeOptions options;
    options.particles = particles;
    System bar = taut::lattice<double>(options);
    for (Index i = 0; i < bar.size(); ++i) {
        const Index x = i % particles[0];
        if (x == 0 || x + 1 == particles[0]) bar.pin(i);
    }
    bar.set_rayleigh({2, 0});  // drag, 1/s, so that it comes to rest
    return bar;
}

void write(const std::string& folder) {
    const System bar = make_bar();
    auto state = bar.initial_state();
    taut::LammpsOptions options;
    options.steps = steps;
    options.every = steps / frames;
    // A pin moves with the velocity that it has. The others begin with theirs, so no wave runs.
    const double h = options.share * taut::any_pose_limit(bar).certified;
    state.v.row(0) = stretch / (h * static_cast<double>(steps)) * state.x.row(0);
    std::printf("%s", example::write_lammps_folder("--write", folder, bar, state, options).c_str());
}

/// The mean breadth, m, of the cross-section in the middle.
double breadth(const taut::Points<double, 3>& x) {
    const auto [nx, ny, nz] = particles;
    double sum = 0;
    for (Index z = 0; z < nz; ++z) {
        const Index row = z * ny * nx + nx / 2;
        sum += x(1, row + (ny - 1) * nx) - x(1, row);
    }
    return sum / static_cast<double>(nz);
}

void read(const std::string& folder) {
    const System bar = make_bar();
    auto state = bar.initial_state();
    const taut::Points<double, 3> rest = state.x;
    taut::MeshEdges edges;
    bar.for_each_spring([&](Index a, Index b) { edges.push_back({a, b}); });
    taut::PlySequence pictures(folder + "/frame_", {}, edges);
    taut::LammpsDump<double, 3> dump(folder + "/taut.dump", bar.size());
    taut::Points<double, 3> force;
    std::printf("   time   stretch   contraction/stretch   pull\n");
    auto report = dump.read(state);
    for (; report; report = dump.read(state)) {
        if (const auto written = pictures.write(state.x); !written)
            throw std::runtime_error("--read: " + written.message());
        const Index last = particles[0] - 1;
        const double strain = (state.x(0, last) - state.x(0, 0)) / rest(0, last) - 1;
        const double thinner = 1 - breadth(state.x) / breadth(rest);
        bar.force(state, force);
        double pull = 0;
        for (Index i = last; i < bar.size(); i += particles[0]) pull -= force(0, i);
        std::printf("%7.3f   %7.4f   %19.3f   %.1f N\n", state.time, strain,
                    strain > 0 ? thinner / strain : 0.0, pull);
    }
    if (report.status != taut::DumpStatus::end)
        throw std::runtime_error("--read: " + report.message());
}

int run(int argc, char** argv) {
    std::string written, looked_at;
    CLI::App app{"A bar of a cubic lattice, stretched by LAMMPS (docs/lammps.md)."};
    example::add_version(app, "lammps_lattice");
    auto* out = app.add_option("--write", written, "write the bar for LAMMPS into this folder")
                    ->check(example::not_empty());
    app.add_option("--read", looked_at, "say what LAMMPS made of it there, and write pictures")
        ->check(example::not_empty())
        ->excludes(out);
    CLI11_PARSE(app, argc, argv)
    if (written.empty() && looked_at.empty())
        throw std::runtime_error("give --write FOLDER or --read FOLDER (see --help)");
    if (!written.empty()) write(written);
    if (!looked_at.empty()) read(looked_at);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return example::guarded_main("lammps_lattice", [&] { return run(argc, argv); });
}
