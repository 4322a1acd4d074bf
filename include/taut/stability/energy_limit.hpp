// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../model/spring_system.hpp"
#include "detail/symplectic_limit.hpp"
#include "spring_pencil.hpp"

namespace taut {

namespace stability_detail {

/// M ⪰ h²L_k + ½hD is 4M ⪰ 2H(½D) + H²L_k with H = 2h: half of symplectic Euler's limit at half the
/// damping.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> energy_bracket(const SpringSystem<Scalar, Dim, Laws...>& system, Effort& effort) {
    const auto laplacian = SpringPencil<1>::any_pose(system, SpringPencil<1>::Damping::half);
    if (!laplacian.lost().empty()) {
        return rounded<Scalar>({0, infinity, Cause::overflow}, system.revision());
    }
    const auto start = [&](double h) {
        return leading_pair(laplacian, 2 * h * D + h * h * K_plus).vector;
    };
    UnroundedLimit limit = symplectic_limit(laplacian, effort, 0, start);
    limit.certified /= 2;
    limit.refuted /= 2;
    return rounded<Scalar>(limit, system.revision());
}

}  // namespace stability_detail

/// The steps of EnergyStableEuler that cannot gain energy, at any pose, any speed, for all time
/// [T42]: those with M ⪰ h²L_k + ½hD. L_k is the graph Laplacian of the laws' stiffness bounds; D
/// bounds all damping of the system at every pose: drag d0·M, dampers L_c, Rayleigh's αL_k. Without
/// damping it is half of any_pose_limit. By the splitting bound alone, O(springs) for each of a few
/// passes [T26].
///
/// `certified`, s, is proved; above `refuted` the condition fails. That ends the proof, not the
/// scene: some motion may gain energy there, most will not. Infinite where nothing is pulled or
/// damped. External forces bring their work, and no condition. Void like any_pose_limit's answer.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> energy_limit(const SpringSystem<Scalar, Dim, Laws...>& system) {
    stability_detail::Effort bounds;
    return stability_detail::energy_bracket(system, bounds);
}

}  // namespace taut
