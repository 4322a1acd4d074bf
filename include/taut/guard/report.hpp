// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>

#include "../core/error.hpp"
#include "../core/status.hpp"
#include "../core/types.hpp"

namespace taut {

/// What a frame of Guard may cost. The defaults need no thought.
template <class Scalar>
struct GuardOptions {
    Scalar share = static_cast<Scalar>(0.95);  ///< of any_pose_limit, ≤ 1, in an explicit trial
    Scalar max_step = std::numeric_limits<Scalar>::infinity();  ///< s, > 0, of any trial
    /// A frame whose trial needs more is shortened to this many steps, so that a late frame does
    /// not make the next one later.
    Index max_substeps = 1000;
    int threads = 1;  ///< of the explicit steppers that the guard makes, as ExplicitOptions has it

    /// Fails by name unless every value is in range.
    void require_valid() const {
        require_positive("Guard", "share", share);
        if (share > 1) fail("Guard: share is ", share, "; it must be <= 1");
        if (!(max_step > 0)) fail("Guard: max_step is ", max_step, "; it must be > 0");
        if (max_substeps < 1) fail("Guard: max_substeps is ", max_substeps, "; it must be >= 1");
    }
};

/// How a frame was taken: the trial stands as it is, or with its end velocities trimmed, or the
/// frame was taken again by EnergyStableEuler.
enum class Taken { tried, trimmed, again };

/// The books of a frame, of one part or of all; a part is free particles joined by springs.
struct GuardBooks {
    Taken taken = Taken::tried;
    double energy = 0;    ///< E: kinetic, springs', gravity's, of free particles, J
    double kinetic = 0;   ///< K, about the centre of mass of each part, J
    double work = 0;      ///< W, by moving pins and outside forces, J
    double loss = 0;      ///< Q, what damping took, J
    double credit = 0;    ///< d ≤ 0, what was lost beyond the books and may be gained back, J
    double rounding = 0;  ///< ρ, what rounding may have made, J
    Index particle = -1;  ///< the first of the part, or of the worst part

    /// Whether rounding hides gains: subtract an origin that follows the part, or use double.
    bool blind() const { return rounding > kinetic / 100; }
};

/// Outcome of Guard::advance, with the sums over all parts.
template <class Scalar>
struct [[nodiscard]] GuardReport : GuardBooks {
    Status status = Status::ok;
    Scalar advanced = 0;  ///< s; less than the frame if max_substeps cut it, 0 where refused
    Index substeps = 0;   ///< of the trial
    Scalar h = 0;         ///< its step, s
    Index parts = 0;
    Index trimmed = 0;  ///< parts
    Index again = 0;    ///< parts
    Index where = -1;   ///< where refused: a particle that is not finite
    /// Of unproved_stiffness: the law, and the spring's index in the system.
    std::string law;
    Index spring = -1;
    /// The outside force, by the function that set it, that is too stiff for the steps.
    const char* force = nullptr;

    /// Whether status is ok.
    explicit operator bool() const { return status == Status::ok; }
};

}  // namespace taut
