// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <taut/lammps/lammps.hpp>
#include <taut/lattice/lattice.hpp>

namespace bench {

/// A lattice of about so many springs. @param diagonals  nine springs a particle, else three
inline taut::SpringSystem<double, 3> lattice_of(double springs, bool diagonals) {
    taut::LatticeOptions options;
    if (!diagonals) options.diagonal = 0;
    const taut::Index edge = std::lround(std::cbrt(springs / (diagonals ? 9 : 3)));
    options.particles = {edge, edge, edge};
    return taut::lattice<double>(options);
}

/// For a run whose loop writes nothing: frames and energies of its start are not part of it.
inline taut::LammpsOptions lammps_steps_alone(taut::Index steps) {
    taut::LammpsOptions options;
    options.steps = steps;
    options.every = steps + 1;
    options.velocities = options.sorted = false;
    return options;
}

/// Whether there is a LAMMPS to run.
inline bool has_lammps() {
    return std::system("command -v mpirun > /dev/null && command -v lmp > /dev/null") == 0;
}

/// Whether LAMMPS ended well. The environment makes ranks of Open MPI wait without a processor of
/// their own, and as root, as in containers.
inline bool lammps(const char* program, const std::string& folder, int ranks) {
    const std::string command =
        "cd '" + folder +
        "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1 "
        "OMPI_MCA_rmaps_base_oversubscribe=1 mpirun -n " +
        std::to_string(ranks) + " lmp -log none -in taut.in > taut.log 2>&1";
    if (std::system(command.c_str()) == 0) return true;
    std::fprintf(stderr, "%s: lmp failed; see %s/taut.log\n", program, folder.c_str());
    return false;
}

/// LAMMPS's own account of the last run: "Loop time of 1.2 on 2 procs", s of the wall's clock.
inline double loop_time(const std::string& folder) {
    double time = 0;
    if (std::FILE* file = std::fopen((folder + "/taut.log").c_str(), "r")) {
        char line[512];
        while (std::fgets(line, sizeof line, file) != nullptr) {
            (void)std::sscanf(line, "Loop time of %lf", &time);
        }
        std::fclose(file);
    }
    return time;
}

}  // namespace bench
