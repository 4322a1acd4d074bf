// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "../model/spring_system.hpp"

namespace taut {

/// Step and damping for a scene that moves. A limit says that no pose's linearisation grows; a
/// scene that moves through poses may gain energy below it, tension-only cloth does. This share of
/// the step, and this whisper of damping, kept the energy of every scene tried: measured, not
/// proved (docs/theory.md, section 17). energy_limit is proved, at the same step, but slows
/// rotation.
struct Recipe {
    double safety = 0.5;          ///< share of any_pose_limit
    StepDamping damping{0.4, 0};  ///< for ExplicitOptions
};
inline constexpr Recipe recipe;

/// Of the explicit steppers.
struct ExplicitOptions {
    /// For the springs of a SpringSystem, with OpenMP (-fopenmp) only. The result has the same bits
    /// for any number; scenes below some thousands of particles are stepped by one.
    int threads = 1;
    /// Of a SpringSystem's springs. The linear limits of symplectic Euler and velocity Verlet do
    /// not count it: with a share of a in all, step at most 1/(1 + 2a) of them [T23]. What
    /// energy_limit asks for is {0, α/h}.
    StepDamping damping{};
};

/// The share of a linear limit, which does not count a stepper's own damping, that `safety` leaves
/// of it: at most 1/(1 + 2a) with a of own damping, by its step [T23].
inline double share_of_limit(double safety, const StepDamping& own) {
    return std::min(safety, 1 / (1 + 2 * own.total()));
}

namespace integrator_detail {

/// Fails unless a stepper of System can add such a damping of its own.
template <class System>
void require_step_damping(const StepDamping& damping) {
    require_non_negative("ExplicitOptions", "damping.look_ahead", damping.look_ahead);
    require_non_negative("ExplicitOptions", "damping.graph", damping.graph);
    if (damping && !model_detail::is_spring_system_v<System>)
        fail("ExplicitOptions: damping is for the springs of a SpringSystem");
}

}  // namespace integrator_detail
}  // namespace taut
