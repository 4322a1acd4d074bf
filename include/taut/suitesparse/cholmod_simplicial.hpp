// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../tight/detail/factor_rows.hpp"

namespace taut {

/// CHOLMOD's simplicial LLᵀ as proofs use it: Stability<Scalar, CholmodCholesky>. Scalar operations
/// in an order that [T22] covers, unlike the supernodal Cholmod. Needs the CMake target
/// Taut::SuiteSparse.
class CholmodCholesky : private Eigen::CholmodSimplicialLLT<SparseMatrix<double>> {
    using Base = Eigen::CholmodSimplicialLLT<SparseMatrix<double>>;

public:
    CholmodCholesky() { this->cholmod().print = 0; }
    /// Analyses the pattern of a symmetric matrix, both triangles stored.
    /// @returns the most nonzeros in a row of the factor, the diagonal counted
    Index analyze(const SparseMatrix<double>& A) {
        Base::analyzePattern(A);
        if (this->m_cholmodFactor == nullptr) return A.rows();  // out of memory: factorize() fails
        const auto* row = static_cast<const int*>(this->m_cholmodFactor->Perm);
        Eigen::VectorXi place(A.rows());
        for (int k = 0; k < A.rows(); ++k) place[row[k]] = k;
        return solver_detail::factor_size(A, [&](Index i) { return Index(place[i]); }).widest_row;
    }
    /// @returns whether the factorisation ran to completion
    bool factorize(const SparseMatrix<double>& A) {
        if (this->m_cholmodFactor == nullptr) return false;
        Base::factorize(A);
        return Base::info() == Eigen::Success && std::isfinite(least_pivot());
    }
    /// The smallest squared pivot; NaN if one of them is not finite.
    double least_pivot() const {
        const auto* first = static_cast<const int*>(this->m_cholmodFactor->p);
        const auto* value = static_cast<const double*>(this->m_cholmodFactor->x);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < this->m_cholmodFactor->n; ++j) {
            const double pivot = value[first[j]];
            if (!(pivot > 0) || !std::isfinite(pivot)) {
                return std::numeric_limits<double>::quiet_NaN();
            }
            least = std::min(least, pivot);
        }
        return least * least;
    }
};

}  // namespace taut
