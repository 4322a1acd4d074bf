// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "lammps_scene.hpp"
#include "../../mesh_files/detail/output_file.hpp"
#include "text_buffer.hpp"

namespace taut::io_detail {

/// Three numbers, zeros for missing dimensions.
template <class Scalar, int Dim>
void put_triple(TextBuffer& out, const Points<Scalar, Dim>& values, Index i) {
    for (int d = 0; d < 3; ++d) {
        out << ' ' << (d < Dim ? static_cast<double>(values(d < Dim ? d : 0, i)) : 0.0);
    }
}

template <class System>
void put_box(TextBuffer& out, const typename System::State& state, double margin) {
    const char* const ends[] = {" xlo xhi\n", " ylo yhi\n", " zlo zhi\n"};
    for (int d = 0; d < 3; ++d) {
        double low = 0, high = 0;
        if (d < System::Dim) {
            low = static_cast<double>(state.x.row(d < System::Dim ? d : 0).minCoeff());
            high = static_cast<double>(state.x.row(d < System::Dim ? d : 0).maxCoeff());
        }
        // Far from the origin a margin may be less than one ulp.
        const double wide =
            (std::max)(margin, 1e-6 * (std::max)((std::abs)(low), (std::abs)(high)));
        out << low - wide << ' ' << high + wide << ends[d];
    }
}

template <class System>
FileReport write_lammps_data(const std::string& path, const System& system,
                             const typename System::State& state, LammpsBonds& bonds,
                             LammpsAtoms& atoms) {
    OutputFile file(path);
    if (!file.is_open()) return file.report();
    TextBuffer out(file.get());
    const auto n = static_cast<long long>(system.size());
    const bool any_bonds = bonds.types().size() > 0;
    out << "A scene of Taut: m, kg, s, N/m\n\n" << n << " atoms\n";
    out << static_cast<long long>(atoms.types()) << " atom types\n";
    if (any_bonds) {
        out << static_cast<long long>(system.spring_count()) << " bonds\n"
            << static_cast<long long>(bonds.types().size()) << " bond types\n";
    }
    out << '\n';
    put_box<System>(out, state, bonds.longest() > 0 ? bonds.longest() : 1);
    if (!atoms.per_atom()) {
        out << "\nMasses\n\n";
        atoms.for_each_mass([&](Index type, double mass) {
            out << static_cast<long long>(type) << ' ' << mass << '\n';
        });
    }
    if (any_bonds) {
        out << "\nBond Coeffs # harmonic\n\n";
        long long type = 0;
        for (const auto& key : bonds.types().keys()) {
            out << ++type << ' ' << key.first / 2 << ' ' << key.second << '\n';
        }
    }
    out << "\nAtoms # bond\n\n";
    for (Index i = 0; i < system.size(); ++i) {
        out << static_cast<long long>(i + 1) << " 1 "
            << static_cast<long long>(atoms.type(system, i));
        put_triple(out, state.x, i);
        out << '\n';
    }
    if (!state.v.isZero(0)) {
        out << "\nVelocities\n\n";
        for (Index i = 0; i < system.size(); ++i) {
            out << static_cast<long long>(i + 1);
            put_triple(out, state.v, i);
            out << '\n';
        }
    }
    if (any_bonds) {
        out << "\nBonds\n\n";
        long long number = 0;
        bonds.for_each(system, [&](Index type, Index a, Index b) {
            out << ++number << ' ' << static_cast<long long>(type) << ' '
                << static_cast<long long>(a + 1) << ' ' << static_cast<long long>(b + 1) << '\n';
        });
    }
    // LAMMPS of 2022-01 finds no section behind that of a fix.
    if (atoms.per_atom()) {
        out << "\nRmass\n\n";
        for (Index i = 0; i < system.size(); ++i) {
            out << static_cast<long long>(i + 1) << ' ' << static_cast<double>(system.mass(i))
                << '\n';
        }
    }
    out.flush();
    return file.close();
}

}  // namespace taut::io_detail
