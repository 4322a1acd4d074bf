// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/status.hpp"
#include "../core/types.hpp"

namespace taut {

/// Why the guard took a frame back.
enum class Alarm {
    none,
    step_failed,  ///< a substep did not succeed: its state was not finite, or its solver failed
    energy,       ///< the energy rose by more than anything did work
    stiff_force,  ///< it did, counting an external force that changes faster than the step resolves
    response      ///< it did, and what `respond` gave without claiming it explains that
};

/// Outcome of Guarded::advance; false when the frame was given up, and then the state is that of
/// its start.
template <class Scalar>
struct [[nodiscard]] GuardedReport {
    Status status = Status::ok;
    Alarm alarm = Alarm::none;  ///< of the last attempt that was taken back
    Index substeps = 0;         ///< of the last attempt
    Scalar h = 0;               ///< its step, s
    int retries = 0;
    Scalar advanced = 0;     ///< s; less than the frame if max_substeps cut it, 0 on failure
    double energy_rise = 0;  ///< J, by which the last attempt that finished exceeds the account
    double work = 0;         ///< J, by external forces, moving pins, constraints and claims in it
    double response = 0;     ///< J, unclaimed, by `respond`; counted once a frame was taken back
    Index where = -1;        ///< on failure: the first particle not finite, or the fastest
    Index spring = -1;       ///< on failure: the one with the most energy

    /// Whether status is ok.
    explicit operator bool() const { return status == Status::ok; }
};

}  // namespace taut
