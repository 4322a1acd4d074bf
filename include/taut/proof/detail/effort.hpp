// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../step_limit.hpp"
#include "quotients.hpp"

namespace taut::proof_detail {

/// [certified, refuted), s, and the vector that refutes.
struct Bracket {
    double certified = 0;
    double refuted = infinity;
    Eigen::VectorXd vector;
};

/// What a search for a bracket may spend beyond bounds and vectors found by products with the
/// matrices. This one spends nothing; one that factorises narrows what the bounds have left open.
struct NoEffort {
    /// Narrows the bracket of symplectic Euler.
    void narrow_symplectic(const Pencil&, Bracket&) {}
    /// Narrows the bracket of explicit Euler. @param stiffest  the stiffest mode of K⁺ known
    void narrow_explicit(const Pencil&, const RitzPair& /*stiffest*/, UnroundedLimit&) {}
    /// A smaller ε with S ⪰ −εM proved, or the one given. @param epsilon  one that is known, ≥ 0
    double narrow_deficit(const Pencil&, const Combination&, double epsilon) { return epsilon; }
};

}  // namespace taut::proof_detail
