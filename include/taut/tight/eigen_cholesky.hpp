// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "../core/detail/finite.hpp"
#include "detail/factor_rows.hpp"

namespace taut {

/// Eigen's simplicial LLᵀ as certificates use it: scalar operations only, in an order that [T22]
/// covers, and the width of the factor's rows known before it is computed. See EigenCholesky.
template <class Real>  // a template: only its callers compile the factorisation
class SimplicialCholesky : private Eigen::SimplicialLLT<SparseMatrix<Real>> {
    using Base = Eigen::SimplicialLLT<SparseMatrix<Real>>;
    using Base::m_matrix;
    using Base::m_P;

public:
    /// Analyses the pattern of a symmetric matrix, both triangles stored.
    /// @returns the most nonzeros in a row of the factor, the diagonal counted
    Index analyze(const SparseMatrix<Real>& A) {
        Base::analyzePattern(A);
        const bool ordered = m_P.size() > 0;
        const auto place = [&](Index i) { return ordered ? Index(m_P.indices()[i]) : i; };
        return solver_detail::factor_size(A, place).widest_row;
    }
    /// @returns whether the factorisation ran to completion
    bool factorize(const SparseMatrix<Real>& A) {
        Base::factorize(A);
        // A NaN passes Eigen's own test for a positive pivot.
        return Base::info() == Eigen::Success && m_matrix.diagonal().sum() > 0 &&
               detail::is_finite(m_matrix.diagonal().sum());
    }
    /// The smallest squared pivot.
    Real least_pivot() const {
        const auto diagonal = m_matrix.diagonal();
        Real least = diagonal[0];
        for (Index i = 1; i < diagonal.size(); ++i) least = (std::min)(least, diagonal[i]);
        return least * least;
    }
};

/// The factorisation behind proofs. Not one whose kernels multiply by an inverted diagonal block:
/// [T22] does not cover them.
using EigenCholesky = SimplicialCholesky<double>;

}  // namespace taut
