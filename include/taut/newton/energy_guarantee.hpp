// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../network/spring_system.hpp"

namespace taut {

/// Whether theory [T24] covers a scene of this type: every law's energy is convex in the positions,
/// so an implicit Euler step that is solved until the residual r of M(v⁺ − v) = h f(x⁺, v⁺) is
/// small raises the energy by at most |v⁺ᵀr|, at any h and any stiffness.
///
/// Pins must be at rest and external forces absent. One linearised solve is not enough: it does not
/// feel a slack spring that becomes taut within the step.
template <class System>
inline constexpr bool energy_never_rises_v = false;

template <class Scalar, int Dim, class... Laws>
inline constexpr bool energy_never_rises_v<SpringSystem<Scalar, Dim, Laws...>> =
    sizeof...(Laws) > 0 && (network_detail::usable_law<Laws, Scalar>::convex && ...);

template <class System>
inline constexpr bool energy_never_rises_v<const System> = energy_never_rises_v<System>;

}  // namespace taut
