// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "../core/types.hpp"

namespace taut {

/// A vibration of M, D, K⁺ as linear theory has it, and uᵀMu = 1.
struct Mode {
    double k = 0;           ///< uᵀK⁺u, 1/s²
    double d = 0;           ///< uᵀDu, 1/s
    Eigen::VectorXd shape;  ///< u, one entry for each free degree of freedom

    /// √k, rad/s; 0 for k < 0, which is rounding.
    double omega() const { return k > 0 ? std::sqrt(k) : 0; }
    /// Its damping ratio d/(2ω); infinite, or NaN without damping, where ω is 0.
    double zeta() const { return d / (2 * omega()); }
};

}  // namespace taut
