// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../network/spring_system.hpp"
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
    return proof_detail::of_laplacians<Scalar>(Pencil::any_pose(system), system.revision());
}

/// The same for a method: the step above for symplectic Euler and velocity Verlet; that of
/// energy_limit for the energy-stable step; every step of an implicit one. Of explicit Euler
/// nothing is proved at every pose: certified is 0, for the stiffness of a spring across its axis,
/// T/l, falls without end as the spring is compressed, and 4M − 2hD + h²K ≻ 0 [T17] then fails at
/// any h.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> any_pose_limit(const SpringSystem<Scalar, Dim, Laws...>& system, Method method) {
    using namespace proof_detail;
    const Pencil laplacian = Pencil::any_pose(system, counted_at_any_pose(method));
    return rounded<Scalar>(at_any_pose(method, laplacian), system.revision());
}

}  // namespace taut
