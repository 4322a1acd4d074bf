// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../model/spring_system.hpp"
#include "detail/symplectic_limit.hpp"

namespace taut {

/// The step at any pose (linearised): 4M − 2hL_c − h²L_k ≻ 0 on the graph Laplacians proves
/// that symplectic Euler (and velocity Verlet) has no multiplier μ ≤ −1 at any pose [T23]. By the
/// splitting bound alone, O(springs) for each of a few passes [T26].
///
/// It bounds the growth of small vibrations about each pose that a scene moves through, not the
/// energy of the motion. energy_limit bounds that.
/// `certified`, s, is proved; `refuted` is not looked for, see any_pose_bracket in bracket.hpp.
/// Wind and other external forces are not counted: they need not be conservative, nor a drag
/// bounded. Void when stiffness or damping is added, mass removed or a particle unpinned (see
/// StepLimit::step_for).
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> any_pose_limit(const SpringSystem<Scalar, Dim, Laws...>& system) {
    return stability_detail::of_laplacians<Scalar>(Pencil::any_pose(system), system.revision());
}

}  // namespace taut
