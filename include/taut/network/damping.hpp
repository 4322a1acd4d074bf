// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

/// Rayleigh damping D = d0·M + α·K [T28]. Words, because textbooks swap the Greek letters.
struct RayleighDamping {
    double mass_proportional = 0;       ///< d0, 1/s
    double stiffness_proportional = 0;  ///< α, s
};

}  // namespace taut
