// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../model/spring_system.hpp"
#include "detail/symplectic_limit.hpp"
#include "spring_pencil.hpp"

namespace taut {

namespace stability_detail {

template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> any_pose_bracket(const SpringSystem<Scalar, Dim, Laws...>& system,
                                   Effort& effort) {
    const auto laplacian = SpringPencil<1>::any_pose(system);
    if (!laplacian.lost().empty()) {
        return rounded<Scalar>({0, infinity, Cause::overflow}, system.revision());
    }
    const auto start = [&](double h) {
        return leading_pair(laplacian, 2 * h * D + h * h * K_plus).vector;
    };
    return rounded<Scalar>(symplectic_limit(laplacian, effort, 0, start), system.revision());
}

}  // namespace stability_detail

/// The step at any pose (linearised): 4M − 2hL_c − h²L_k ≻ 0 on the graph Laplacians proves
/// that symplectic Euler (and velocity Verlet) has no multiplier μ ≤ −1 at any pose [T23]. By the
/// splitting bound alone [T26].
///
/// It bounds the growth of small vibrations about each pose that a scene moves through, not the
/// energy of the motion. energy_limit bounds that.
/// `certified` is proved; `refuted` is where the condition itself fails: no larger step can be
/// certified for every pose in this way, though a given pose may allow one. Wind and other external
/// forces are not counted: they need not be conservative, nor a drag bounded. Void when stiffness
/// or damping is added, mass removed or a particle unpinned (see StepLimit::step_for).
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> any_pose_limit(const SpringSystem<Scalar, Dim, Laws...>& system) {
    stability_detail::Effort bounds;
    return stability_detail::any_pose_bracket(system, bounds);
}

}  // namespace taut
