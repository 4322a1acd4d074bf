// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "../core/error.hpp"
#include "../core/types.hpp"
#include "explicit_options.hpp"

namespace taut {

/// What a frame of Guarded may cost, and what it counts as a gain of energy.
template <class Scalar>
struct GuardedOptions {
    /// The damping of a stepper that the guard makes without arguments, as shares of a substep:
    /// explicit steppers only. The scene's stays as it is.
    StepDamping damping = recipe.damping;
    /// Of the any-pose limit, in (0, 1]; at most 1/(1 + 2a) is used, with a of own damping. At
    /// a half a linear spring under symplectic Euler swings threefold in energy, at 0.95
    /// thirty-nine times, and tension-only cloth gains energy.
    Scalar safety = static_cast<Scalar>(recipe.safety);
    Scalar max_step = std::numeric_limits<Scalar>::infinity();  ///< s, > 0
    /// A frame that needs more is shortened to this many steps, so that a late frame does not
    /// make the next one later. Retries go beyond it.
    Index max_substeps = 1000;
    int max_retries = 6;  ///< each with twice the substeps, ≤ 30
    /// Share of the largest kinetic and elastic energy of late by which the account may be
    /// exceeded. What it admits once is not admitted again.
    double energy_slack = 0.01;
    double energy_drift = 0.003;  ///< 1/s, share of the same by which the account grows

    /// Fails by name unless every value is in range.
    void require_valid() const {
        require_positive("Guarded", "safety", safety);
        if (safety > 1) fail("Guarded: safety is ", safety, "; it must be <= 1");
        if (!(max_step > 0)) fail("Guarded: max_step is ", max_step, "; it must be > 0");
        if (max_substeps < 1) {
            fail("Guarded: max_substeps is ", max_substeps, "; it must be >= 1");
        }
        if (max_retries < 0 || max_retries > 30) {
            fail("Guarded: max_retries is ", max_retries, "; it must be within 0 and 30");
        }
        if (max_substeps > std::numeric_limits<Index>::max() >> max_retries) {
            fail("Guarded: max_substeps is ", max_substeps, ", which overflows when ", max_retries,
                 " retries double it");
        }
        require_non_negative("Guarded", "energy_slack", energy_slack);
        require_non_negative("Guarded", "energy_drift", energy_drift);
    }
};

}  // namespace taut
