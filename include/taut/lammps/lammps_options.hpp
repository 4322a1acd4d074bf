// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../core/error.hpp"
#include "../mesh_files/file_report.hpp"

namespace taut {

/// What write_lammps() writes beside the scene.
struct LammpsOptions {
    /// Of the certified any-pose limit that a step is, in (0, 1]. LAMMPS cannot look ahead, so that
    /// half of it keeps a moving scene's energy is measured, not proved.
    double share = 0.5;
    double step = 0;         ///< s, in place of that share; 0: by the share
    Index steps = 1000;      ///< of a run, ≥ 1; `lmp -var steps N` changes them
    Index every = 100;       ///< steps from one frame to the next, ≥ 1
    bool nearest = false;    ///< whether what LAMMPS lacks is replaced or left out, with a warning
    bool sorted = true;      ///< whether frames are sorted by particle; one rank then holds them
    bool velocities = true;  ///< whether frames have them
    std::string name = "taut";  ///< of the files: name.data, name.in, and of LAMMPS's name.dump
};

/// What write_lammps() wrote; false when a file is not complete.
struct [[nodiscard]] LammpsReport {
    FileReport file;                    ///< the first that failed, or the script
    double step = 0;                    ///< s, of the script
    double certified = 0;               ///< s: the any-pose limit of velocity Verlet
    Index bond_types = 0;               ///< pairs of stiffness and rest length
    Index atom_types = 0;               ///< masses of free and of pinned particles
    bool mass_per_atom = false;         ///< whether each particle has its own
    double cutoff = 0;                  ///< m: no bond of several ranks may become longer
    std::vector<std::string> warnings;  ///< sentences on what differs from the scene

    /// Whether all was written.
    explicit operator bool() const { return static_cast<bool>(file); }
};

namespace io_detail {

inline void require_options(const LammpsOptions& options) {
    const auto require_count = [](const char* argument, Index value) {
        if (value < 1) fail("write_lammps: ", argument, " is ", value, "; it must be >= 1");
    };
    require_positive("write_lammps", "share", options.share);
    if (options.share > 1) {
        fail("write_lammps: share is ", options.share,
             "; it must be <= 1, which is all of the certified limit");
    }
    require_non_negative("write_lammps", "step", options.step);
    require_count("steps", options.steps);
    require_count("every", options.every);
    // The script names them without quotes, beside its own words.
    const char* const plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
    if (options.name.empty() || options.name.find_first_not_of(plain) != std::string::npos) {
        fail("write_lammps: name is \"", options.name,
             "\"; it must consist of letters, digits, '_', '-' and '.'");
    }
}

}  // namespace io_detail
}  // namespace taut
