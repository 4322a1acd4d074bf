// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <taut/lammps/lammps.hpp>

#include "naming.hpp"
#include "number.hpp"

namespace example {

/// Writes a scene for LAMMPS into a folder, which is made where it is missing. Throws with a
/// message for the user, which begins with `option`.
/// @returns some lines on what was written
template <class System, class State>
std::string write_lammps_folder(const std::string& option, const std::string& folder,
                                const System& system, const State& state,
                                const taut::LammpsOptions& options = {}) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);  // what fails shows when files are written
    const auto report =
        naming(option, [&] { return taut::write_lammps(folder, system, state, options); });
    if (!report) throw std::runtime_error(option + ": " + report.file.message());
    char line[256];
    std::snprintf(line, sizeof line,
                  "For LAMMPS: %lld bond types, %lld atom types, bonds up to %.4g m\n"
                  "  step %s s, %.3g of the limit at any pose\n",
                  static_cast<long long>(report.bond_types),
                  static_cast<long long>(report.atom_types), report.cutoff,
                  rounded_down(report.step, 5).c_str(), report.step / report.certified);
    std::string text = line;
    for (const auto& warning : report.warnings) text += "  differs: " + warning + "\n";
    return text + "  cd " + folder + " && mpirun -n 2 lmp -in " + options.name + ".in\n";
}

}  // namespace example
