// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/CholmodSupport>
#include <type_traits>

#include "../core/buffer.hpp"
#include "../solver/block_ordering.hpp"

namespace taut {

/// CHOLMOD's supernodal LLᵀ as a Solver for the symmetric step; double only. Needs the CMake target
/// Taut::SuiteSparse. The supernodal module is GPL-2+: linking it puts your program under the GPL.
///
/// Orders the graph of particles, by AMD and by METIS where CHOLMOD has it, and keeps the order
/// with fewer operations.
template <class Scalar = double>
class Cholmod : public Eigen::CholmodSupernodalLLT<SparseMatrix<Scalar>> {
    using Base = Eigen::CholmodSupernodalLLT<SparseMatrix<Scalar>>;
    static_assert(std::is_same_v<Scalar, double>, "taut::Cholmod: CHOLMOD works in double only");

public:
    Cholmod() { this->cholmod().print = 0; }  // a failure is reported by info(), not on the console

    /// @param A  compressed, with both triangles
    void analyzePattern(const SparseMatrix<Scalar>& A);
    /// @param A  of the pattern analysed; indefinite: info() is not Eigen::Success
    void factorize(const SparseMatrix<Scalar>& A) {
        // Where the analysis ran out of memory, info() says so already.
        if (this->m_cholmodFactor) Base::factorize(A);
    }
    /// analyzePattern() and factorize().
    Cholmod& compute(const SparseMatrix<Scalar>& A) {
        analyzePattern(A);
        factorize(A);
        return *this;
    }
};

template <class Scalar>
void Cholmod<Scalar>::analyzePattern(const SparseMatrix<Scalar>& A) {
    cholmod_common& common = this->cholmod();
    const solver_detail::CompressedGraph graph(A);
    auto vertices = Eigen::viewAsCholmod(graph.matrix.template selfadjointView<Eigen::Lower>());
    common.nmethods = 2;
    common.method[0].ordering = CHOLMOD_AMD;
    common.method[1].ordering = CHOLMOD_METIS;
    cholmod_factor* order = cholmod_analyze(&vertices, &common);
    Buffer<int> columns(A.cols(), 0);
    if (order) graph.expand(static_cast<const int*>(order->Perm), columns);
    if (this->m_cholmodFactor) cholmod_free_factor(&this->m_cholmodFactor, &common);
    common.nmethods = 1;
    common.method[0].ordering = order ? CHOLMOD_GIVEN : CHOLMOD_NATURAL;
    cholmod_free_factor(&order, &common);
    auto matrix = Eigen::viewAsCholmod(A.template selfadjointView<Eigen::Lower>());
    this->m_cholmodFactor = cholmod_analyze_p(&matrix, columns.data(), nullptr, 0, &common);
    this->m_isInitialized = true;
    this->m_analysisIsOk = this->m_cholmodFactor != nullptr;
    this->m_info = this->m_analysisIsOk ? Eigen::Success : Eigen::NumericalIssue;
    this->m_factorizationIsOk = false;
}

}  // namespace taut
