// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>

#include "../../proof/pencil_matrix.hpp"

namespace taut::proof_detail {

/// Number of eigenvalues of M⁻¹K⁺ below 1e-10·k_max: the negative pivots of K⁺ − εM, by Sylvester's
/// law of inertia. Numerical: the factorisation of an indefinite matrix has no error bound.
template <class Real = double>  // a template: only its callers compile the factorisation
Index count_zero_modes(const Pencil& pencil, double k_max) {
    if (!(k_max > 0)) return pencil.size();
    const double epsilon = 1e-10 * k_max;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(
        pencil.assemble(matrices::K_plus - epsilon * matrices::M));
    return (ldlt.vectorD().array() < 0).count();
}

}  // namespace taut::proof_detail
