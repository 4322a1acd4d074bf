// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the module tight.

#include <algorithm>
#include <cmath>
#include <vector>

#include "../core/buffer.hpp"
#include "../network/free_particles.hpp"
#include "../network/spring_system.hpp"
#include "../proof/pencil.hpp"
#include "detail/low_modes.hpp"

namespace taut {

using proof_detail::frequency_changes;

/// Answer of added_mass.
struct AddedMass {
    bool reached =
        false;  ///< false: d0 alone forbids this step whatever the masses, or they overflow
    std::vector<double> mass;  ///< kg to add to each particle; 0 for pinned ones
    double total = 0;          ///< kg
    /// Relative change of the lowest frequencies, up to ten, zero modes apart: see
    /// frequency_changes.
    std::vector<double> frequency_change;
};

/// Selective mass scaling: masses to add so that step h of symplectic Euler can be proved, s, in
/// this pose, few and small: particle i needs m_i(4 − 2h·d0) ≥ λ_max(Σ_b (1 + p_b/p_i)(2hD_b +
/// h²P_b)) [T26], and the weights p are improved to ask for little in all. Added mass slows the
/// motion: see frequency_change.
template <class Scalar, int Dim, class... Laws>
AddedMass added_mass(const SpringSystem<Scalar, Dim, Laws...>& system,
                     const State<Scalar, Dim>& state, double h) {
    require_positive("added_mass", "h", h);
    if (state.x.cols() != system.size() || !detail::all_finite(state.x)) {
        fail("added_mass: the state has ", state.x.cols(), " positions; the system has ",
             system.size(), " particles, and each position must be finite");
    }
    constexpr int repeats = 60;
    // For the rounding of the masses themselves, which the caller sets as Scalars.
    const double margin =
        1 + 1e-9 + 4 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    AddedMass added;
    added.mass.assign(static_cast<std::size_t>(system.size()), 0);
    const double budget = 4 - 2 * h * system.rayleigh().mass_proportional;
    if (!(budget > 0)) return added;
    const auto pencil = Pencil::at_pose(system, state.x.template cast<TangentReal<Scalar>>());
    const FreeParticles free(system);
    const auto count = static_cast<std::size_t>(free.count());
    std::vector<double> mass;
    std::vector<double> p;
    for (const Index i : free) {
        mass.push_back(static_cast<double>(system.mass(i)));
        p.push_back(1 / std::sqrt(mass.back()));
    }
    double best = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < repeats; ++repeat) {
        const auto needed =
            pencil.particle_loads(2 * h * matrices::D + h * h * matrices::K_plus, p);  // N s²/m, kg
        double total = 0;
        for (std::size_t i = 0; i < count; ++i) {
            total += (std::max)(0.0, needed[i] / budget * margin - mass[i]);
        }
        if (total < best) {
            best = total;
            for (Index j = 0; j < free.count(); ++j) {
                detail::at(added.mass, free[j]) =
                    (std::max)(0.0, detail::at(needed, j) / budget * margin - detail::at(mass, j));
            }
        }
        // A particle with mass to spare takes over from its neighbours by a smaller weight.
        for (std::size_t i = 0; i < count; ++i) {
            const double use = needed[i] / (budget * mass[i]);
            p[i] *= std::sqrt(std::clamp(use, 1e-4, 1.0));
        }
    }
    added.reached = detail::is_finite(best);
    const auto sum = [&](Index i) {
        return static_cast<Scalar>(static_cast<double>(system.mass(i)) + detail::at(added.mass, i));
    };
    for (const Index i : free) added.reached = added.reached && detail::is_finite(sum(i));
    if (!added.reached) {
        added.mass.assign(added.mass.size(), 0);
        return added;
    }
    added.total = best;
    auto heavier = system;
    for (const Index i : free) heavier.set_mass(i, sum(i));
    added.frequency_change = proof_detail::frequency_changes(
        pencil, Pencil::at_pose(heavier, state.x.template cast<TangentReal<Scalar>>()));
    return added;
}

}  // namespace taut
