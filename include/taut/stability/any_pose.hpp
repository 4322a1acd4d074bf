// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../model/spring_system.hpp"
#include "detail/limits.hpp"
#include "spring_pencil.hpp"

namespace taut {

/// The step that holds while the scene moves: 4M − 2hL_c − h²L_k ≻ 0 on the graph Laplacians proves
/// that symplectic Euler (and velocity Verlet) has no multiplier μ ≤ −1 at any pose [T23].
///
/// `certified` is proved by the splitting bound [T26]. `refuted` is where the condition itself fails:
/// no larger step can be certified for every pose, though a given pose may allow one. Void when
/// stiffness or damping is added, mass removed or a particle unpinned (see StepLimit::step_for).
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> any_pose_limit(const SpringSystem<Scalar, Dim, Laws...>& system) {
    const auto laplacian = SpringPencil<1>::any_pose(system);
    const double certified =
        laplacian.size() == 0 ? detail::infinity : detail::certified_symplectic(laplacian);
    if (!std::isfinite(certified)) {
        return {static_cast<Scalar>(certified), static_cast<Scalar>(certified),
                Cause::nothing_to_limit, 0, system.revision()};
    }
    RitzPair mode = largest_ritz_pair(laplacian, {0, certified * certified, 2 * certified});
    const double refuted = detail::refuted_symplectic(laplacian, mode);
    const double d = detail::quotients(laplacian, mode.vector, true).d.value;
    return {detail::round_down<Scalar>(certified), detail::round_up<Scalar>(refuted),
            certified * d > 1 ? Cause::damping : Cause::stiffness, 0, system.revision()};
}

}  // namespace taut
