// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/types.hpp"

namespace taut {

/// A linear system M ü + D u̇ + K u = f in r of its modes, u ≈ Φq, one scalar equation each:
///
///     q̈ + d q̇ + k q = p,   ΦᵀMΦ = I,  k = diag ΦᵀKΦ,  d = diag ΦᵀDΦ,  p = Φᵀf.
/// What ΦᵀDΦ has off its diagonal is dropped; for Rayleigh damping on K that is nothing.
struct ModalBasis {
    Eigen::VectorXd k;       ///< r, 1/s², ascending; exactly 0 for a rigid motion or mechanism
    Eigen::VectorXd d;       ///< r, 1/s
    Eigen::VectorXd p;       ///< r, of the constant load, m·√kg/s²
    Eigen::MatrixXd shapes;  ///< Φ, N × r, 1/√kg

    /// r, the number of modes.
    Index size() const { return k.size(); }
    /// Modes without stiffness; they come first, after those of a buckled pose (k < 0).
    Index rigid() const { return (k.array() == 0).count(); }
};

}  // namespace taut
