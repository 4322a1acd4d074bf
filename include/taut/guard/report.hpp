// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "../core/error.hpp"
#include "../core/status.hpp"
#include "../core/types.hpp"

namespace taut {

/// What a frame of Guarded may cost.
template <class Scalar>
struct GuardedOptions {
    /// s, > 0: the longest step of the trial. An implicit stepper takes a frame at once without it.
    Scalar max_step = std::numeric_limits<Scalar>::infinity();
    /// ≥ 1. A frame whose trial needs more steps is shortened to so many: a late frame does not
    /// make the next one later. What is taken again may need more.
    Index max_substeps = 1000;

    /// Fails by name unless every value is in range.
    void require_valid() const {
        if (!(max_step > 0) || !detail::is_finite(1 / max_step))
            fail("Guarded: max_step is ", max_step, "; it must be > 0");
        if (max_substeps < 1) {
            fail("Guarded: max_substeps is ", max_substeps, "; it must be >= 1");
        }
    }
};

/// What became of a part of the scene in a frame of Guarded, from best to worst.
enum class Taken {
    tried,    ///< the trial stands
    trimmed,  ///< it stands with its end velocities trimmed: it had gained energy
    again,    ///< the part went back and took the frame by EnergyStableEuler
    frozen    ///< so did that gain energy, by a force given as code: the part was stopped
};

/// Outcome of Guarded::advance; false where a part was frozen, or where the frame was refused and
/// the state is that of its start.
template <class Scalar>
struct [[nodiscard]] GuardedReport {
    Status status = Status::ok;
    Taken taken = Taken::tried;                ///< of all parts, the worst
    Index parts = 0;                           ///< free particles joined by springs
    Index trimmed = 0, again = 0, frozen = 0;  ///< how many of them
    Index substeps = 0;                        ///< of the trial
    Scalar h = 0;                              ///< its step, s
    Scalar advanced = 0;  ///< s; less than the frame if max_substeps cut it, 0 if refused
    double energy = 0;    ///< E at the end, J, summed over the parts like all that follows
    double work = 0;      ///< W, by outside forces, moving pins, constraints and `respond`, J
    double balance = 0;   ///< d, gained beyond the books; < 0: may be gained back, J
    double slack = 0;     ///< ρ + σ, what rounding and code forces may hide, J
    bool blind = false;   ///< whether ρ is above a hundredth of a part's K, and may hide 1 mm/s
    Index where = -1;     ///< a particle of the worst part, or the one that is not finite
    Index spring = -1;    ///< one that pulls more than its law's stiffness_bound allows
    const char* force =
        nullptr;  ///< what set one that is not finite, or too stiff for the step; or "respond"

    /// Whether status is ok.
    explicit operator bool() const { return status == Status::ok; }
};

}  // namespace taut
