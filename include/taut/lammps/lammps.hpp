// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the module mesh_files.

#include <cmath>
#include <string>
#include <utility>

#include "../core/detail/fits.hpp"
#include "../proof/any_pose.hpp"
#include "detail/lammps_data.hpp"
#include "detail/lammps_script.hpp"
#include "lammps_dump.hpp"
#include "lammps_options.hpp"

namespace taut {

/// Writes a scene for LAMMPS, a data file and an input script, whose velocity Verlet it steps by a
/// share of the proved any-pose limit [T23]:
///
///     v½ = v + ½h M⁻¹f,  x⁺ = x + h v½,  f⁺ = f(x⁺, v½),  v⁺ = v½ + ½h M⁻¹f⁺,
///
/// which is taut::VelocityVerlet, so the limit is that of the run. It holds in exact arithmetic, at
/// each pose, for small vibrations. Its units are `si`, in which m, kg, s and N go through.
///
///     springs   bond_style harmonic, K = k/2: E = K(l − L)². One bond type for each (k, L)
///     masses    one atom type for each mass, of free and of pinned particles
///     pins      fix setforce 0: they move with the velocities that the state gives them
///     gravity   fix gravity; drag d0: fix viscous, γ = d0·m
///
/// The box is open and follows the particles, so no bond is too long for it. But LAMMPS tells a
/// rank only of the particles within LammpsReport::cutoff, twice the longest bond now or at rest: a
/// bond must not become longer, or LAMMPS may stop ("Bond atoms missing"). In one or two dimensions
/// the missing coordinates are and stay 0. Particle i has the id i + 1. What LAMMPS lacks is
/// refused by name or, with LammpsOptions::nearest, left out with a warning: dampers, damping in
/// proportion to stiffness, forces from outside, slack of TensionOnly. The scene as written then
/// has a limit at least as large. Other laws are refused.
///
/// Cost: O(springs); beside the scene it takes the memory of the types and of any_pose_limit.
/// LAMMPS of 2022-01 and later reads it (packages MOLECULE, and for many masses none more).
/// @param folder  there already; "" is the working directory
/// @param state   Dim × n, m and m/s; its time is not kept: LAMMPS begins at 0
template <class Scalar, int Dim, class... Laws>
LammpsReport write_lammps(const std::string& folder,
                          const SpringSystem<Scalar, Dim, Laws...>& system,
                          const State<Scalar, Dim>& state, const LammpsOptions& options = {}) {
    io_detail::require_options(options);
    detail::require_fits("write_lammps", state, system.size());
    if (system.size() == 0) fail("write_lammps: the system has no particles");
    LammpsReport report;
    const std::string stem =
        (folder.empty() || folder.back() == '/' ? folder : folder + '/') + options.name;
    report.file.path = stem + ".in";
    if (const Index i = state.first_not_finite(); i >= 0) {
        report.file = {FileStatus::not_finite, stem + ".data", i};
        return report;
    }

    io_detail::LammpsEquals equals(options.nearest);
    io_detail::check_forces(system, equals);
    Index first = 0;
    system.for_each_set([&](const auto& set) {
        io_detail::check_law(set, first, equals);
        first += set.size();
    });
    report.warnings = std::move(equals.warnings);
    io_detail::LammpsBonds bonds;
    bonds.count(system, state);
    io_detail::LammpsAtoms atoms(system);
    report.bond_types = bonds.types().size();
    report.atom_types = atoms.types();
    report.mass_per_atom = atoms.per_atom();
    report.cutoff = 2 * bonds.longest();
    if (!detail::is_finite(2 * report.cutoff)) {
        fail("write_lammps: twice the longest spring is ", report.cutoff, " m; it must be finite");
    }

    report.certified = static_cast<double>(any_pose_limit(system).certified);
    report.step = options.step > 0 ? options.step : options.share * report.certified;
    if (!(report.step > 0) || !detail::is_finite(report.step)) {
        fail("write_lammps: the certified step is ", report.certified,
             " s, of which no share is a step; give LammpsOptions::step");
    }
    if (report.step > report.certified) {
        report.warnings.push_back("the step of " + detail::text(report.step) +
                                  " s is not certified: the limit at any pose is " +
                                  detail::text(report.certified) + " s");
    }

    report.file = io_detail::write_lammps_data(stem + ".data", system, state, bonds, atoms);
    if (!report.file) return report;
    report.file = io_detail::write_lammps_script(stem + ".in", system, atoms, bonds.longest(),
                                                 options, report);
    return report;
}

}  // namespace taut
