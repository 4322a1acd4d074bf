// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "../lammps_options.hpp"
#include "lammps_scene.hpp"
#include "../../mesh_files/detail/output_file.hpp"
#include "text_buffer.hpp"

namespace taut::io_detail {

/// The fixes. LAMMPS applies them in the order of the script: forces add up, and the last one takes
/// them from the pins.
template <class System>
void put_fixes(TextBuffer& out, const System& system, const LammpsAtoms& atoms) {
    constexpr int Dim = System::Dim;
    out << "\nfix move all nve  # velocity Verlet\n";
    const Eigen::Matrix<double, Dim, 1> gravity = system.gravity().template cast<double>();
    if (!gravity.isZero(0)) {
        out << "fix weight all gravity " << gravity.stableNorm() << " vector";
        for (int d = 0; d < 3; ++d) out << ' ' << (d < Dim ? gravity[d < Dim ? d : 0] : 0.0);
        out << "\nfix_modify weight energy yes\n";
    }
    // As the system's own forces hold it.
    const double d0 = held_as<typename System::Scalar>(system.rayleigh().mass_proportional);
    if (d0 > 0 && atoms.per_atom()) {
        for (const char axis : {'x', 'y', 'z'}) {
            out << "variable drag_" << axis << " atom " << -d0 << "*mass*v" << axis << '\n';
        }
        out << "fix drag all addforce v_drag_x v_drag_y v_drag_z\n";
    } else if (d0 > 0) {
        out << "fix drag all viscous " << d0;
        atoms.for_each_mass([&](Index type, double mass) {
            out << " &\n    scale " << static_cast<long long>(type) << ' ' << mass;
        });
        out << '\n';
    }
    if (atoms.types() > atoms.free_types()) {
        out << "group pinned type " << static_cast<long long>(atoms.free_types() + 1) << ':'
            << static_cast<long long>(atoms.types())
            << "\nfix hold pinned setforce 0 0 0  # they keep the velocities of the data file\n";
    }
}

/// @param longest  bond, m, now or at rest; 0: there is none
template <class System>
FileReport write_lammps_script(const std::string& path, const System& system,
                               const LammpsAtoms& atoms, double longest,
                               const LammpsOptions& options, const LammpsReport& report) {
    OutputFile file(path);
    if (!file.is_open()) return file.report();
    TextBuffer out(file.get());
    const char* const name = options.name.c_str();
    out << "# A scene of Taut. mpirun -n 2 lmp -in " << name << ".in\n"
        << "# SI numbers go through as they are. With -var steps N it takes N steps.\n"
        << "variable steps index " << static_cast<long long>(options.steps)
        << "\nvariable every index " << static_cast<long long>(options.every)
        << "\n\nunits si\natom_style bond\natom_modify map yes sort 0 0.0\n"
        << "boundary s s s  # open: the box follows the particles\n"
        << "special_bonds lj/coul 1 1 1  # or LAMMPS lists neighbours of neighbours for nothing\n"
        << "pair_style none\n";
    if (longest > 0) {
        out << "bond_style harmonic\ncomm_modify cutoff " << report.cutoff
            << "  # m: no longer bond is followed from rank to rank\n";
    }
    // Ranks exchange particles when one has moved by half of it.
    out << "neighbor " << (longest > 0 ? 0.3 * longest : 1.0) << " bin\n"
        << "neigh_modify every 1 delay 0 check yes\n";
    if (atoms.per_atom()) {
        out << "fix mass all property/atom rmass ghost yes\nread_data " << name
            << ".data fix mass NULL Rmass\n";
    } else {
        out << "read_data " << name << ".data\n";
    }
    put_fixes(out, system, atoms);
    out << "\ntimestep " << report.step << "  # s; certified at any pose: " << report.certified
        << " s\nthermo_style custom step time pe ke etotal\n"
        << "thermo_modify norm no format float %.15g\nthermo ${every}\n"
        << "dump frames all custom ${every} " << name << ".dump id x y z"
        << (options.velocities ? " vx vy vz" : "") << "\ndump_modify frames "
        << (options.sorted ? "sort id " : "") << "time yes units yes format float %.17g\n"
        << "run ${steps}\n";
    out.flush();
    return file.close();
}

}  // namespace taut::io_detail
