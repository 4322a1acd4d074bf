// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../core/error.hpp"
#include "../integrator/explicit_options.hpp"
#include "../mesh_files/file_report.hpp"

namespace taut {

/// What write_lammps() writes beside the scene.
struct LammpsOptions {
    double share = recipe.safety;  ///< of the certified any-pose limit that a step is, in (0, 1]
    double step = 0;               ///< s, in place of that share; 0: by the share
    Index steps = 1000;            ///< of a run, ≥ 1; `lmp -var steps N` changes them
    Index every = 100;             ///< steps from one frame to the next, ≥ 1
    /// How long a bond may become, ≥ 1, in lengths of the longest now or at rest. LAMMPS tells a
    /// rank of the particles so near to it, and stops ("Bond atoms missing") where that is too few.
    double longest_stretch = 2;
    Index most_bond_types = 1 << 20;  ///< pairs of stiffness and rest length; 24 bytes a rank each
    /// Masses, of free and of pinned particles: LAMMPS keeps two tables of most_atom_types²
    /// numbers. Where there are more, each particle brings its mass.
    Index most_atom_types = 256;
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
    const auto require_count = [](const char* argument, Index value, Index least) {
        if (value < least)
            fail("write_lammps: ", argument, " is ", value, "; it must be >= ", least);
    };
    require_positive("write_lammps", "share", options.share);
    if (options.share > 1) {
        fail("write_lammps: share is ", options.share,
             "; it must be <= 1, which is all of the certified limit");
    }
    require_non_negative("write_lammps", "step", options.step);
    require_positive("write_lammps", "longest_stretch", options.longest_stretch);
    if (options.longest_stretch < 1) {
        fail("write_lammps: longest_stretch is ", options.longest_stretch,
             "; it must be >= 1, or bonds are too long from the start");
    }
    require_count("steps", options.steps, 1);
    require_count("every", options.every, 1);
    require_count("most_bond_types", options.most_bond_types, 1);
    require_count("most_atom_types", options.most_atom_types, 2);
    // The script names them without quotes, beside its own words.
    const char* const plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
    if (options.name.empty() || options.name.find_first_not_of(plain) != std::string::npos) {
        fail("write_lammps: name is \"", options.name,
             "\"; it must consist of letters, digits, '_', '-' and '.'");
    }
}

}  // namespace io_detail
}  // namespace taut
