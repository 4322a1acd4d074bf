// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../network/spring_system.hpp"
#include "detail/symplectic_limit.hpp"

namespace taut {

/// The steps of EnergyStableEuler that cannot gain energy, at any pose, any speed, for all time
/// [T42]: those with M ⪰ h²L_k + ½hD. L_k is the graph Laplacian of the laws' stiffness bounds; D
/// bounds all damping of the system at every pose: drag d0·M, dampers L_c, Rayleigh's αL_k. Without
/// damping it is half of any_pose_limit. By the splitting bound alone, O(springs) for each of a few
/// passes [T26].
///
/// `certified`, s, is proved; `refuted` is not looked for, see energy_bracket. Infinite where
/// nothing is pulled or damped. External forces bring their work, and no condition. Void like
/// any_pose_limit's answer.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> energy_limit(const SpringSystem<Scalar, Dim, Laws...>& system) {
    // M ⪰ h²L_k + ½hD is 4M ⪰ 2H(½D) + H²L_k with H = 2h: half of symplectic Euler's limit at half
    // the damping.
    return proof_detail::of_laplacians<Scalar>(Pencil::any_pose(system, Pencil::Damping::half),
                                               system.revision(), 0.5);
}

}  // namespace taut
