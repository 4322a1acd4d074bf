// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>
#include <taut/mass_scaling/mass_scaling.hpp>
#include <taut/taut.hpp>

// What would make a step of symplectic Euler safe.

namespace example {

/// The part of a limit that a program should use.
inline constexpr double safe_part = 0.95;

/// Each of them alone makes the step safe.
struct Cures {
    double stiffness_scale = 0;  ///< on all stiffness, αK⁺ included; 0: none is proved to do
    double mass_scale = 0;       ///< on all masses, d0·M included; infinity: none is
    std::optional<taut::AddedMass> added_mass;

    /// Nobody makes a shirt so much heavier.
    bool are_near() const { return mass_scale <= 30; }
};

/// Of one pose, by its bound and without a margin.
inline Cures cures(const taut::Stability<double>& stability, double h) {
    return {stability.max_stiffness_scale(taut::Method::symplectic_euler, h),
            stability.min_mass_scale(taut::Method::symplectic_euler, h),
            {}};
}

/// The scene with its particles side by side on a line: its K and D at rest are the graph
/// Laplacians that bound those of the scene at every pose [T23], dampers included.
template <int Dim>
taut::SpringSystem<double, 1> on_a_line(const taut::SpringSystem<double, Dim>& system) {
    using Place = taut::SpringSystem<double, 1>::Vector;
    taut::SpringSystem<double, 1> line;
    for (taut::Index i = 0; i < system.size(); ++i) {
        line.add_particle(Place(static_cast<double>(i)), system.mass(i));
        if (system.is_pinned(i)) line.pin(i);
    }
    for (const auto spring : system.springs()) {
        const double length = std::abs(static_cast<double>(spring.a - spring.b));
        line.add_spring(taut::Spring<double, taut::Hookean>{spring.a, spring.b, spring.parameters,
                                                            length, spring.damping});
    }
    line.set_rayleigh(system.rayleigh());
    return line;
}

/// While the scene moves: so that h, s, is at most 0.95 of the limit at any pose.
/// @param state  the pose about which the frequencies change that added_mass tells of
template <int Dim>
Cures cures_at_any_pose(const taut::SpringSystem<double, Dim>& system,
                        const taut::State<double, Dim>& state, double h) {
    // A billionth more, for a limit is rounded down.
    const double limit = h / safe_part * (1 + 1e-9);
    const auto line = on_a_line(system);
    const auto rest = line.initial_state();
    Cures found = cures(taut::Stability<double>(line, rest), limit);
    auto& added = found.added_mass.emplace(taut::added_mass(line, rest, limit));
    if (!added.reached) return found;
    auto heavier = system;
    for (taut::Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        heavier.set_mass(i, system.mass(i) + added.mass[static_cast<std::size_t>(i)]);
    }
    added.frequency_change = taut::frequency_changes(taut::Pencil::at_pose(system, state.x),
                                                     taut::Pencil::at_pose(heavier, state.x));
    return found;
}

}  // namespace example
