// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "../proof/pencil_matrix.hpp"
#include "eigen_cholesky.hpp"

namespace taut {

/// Outcome of an attempt to prove a matrix positive definite.
struct DefinitenessProof {
    bool proved = false;  ///< false means not proved, never a disproof
    double shift = 0;     ///< subtracted from the diagonal to pay for all rounding, relative to it
    double least_pivot = 0;  ///< squared, of the unit-diagonal matrix: 1 is far from singular
};

namespace proof_detail {

/// γ/(1 − γ) with γ = (q + 1)u/(1 − (q + 1)u), rounded up [T22]: u of rounding in any direction.
inline double cholesky_rounding(Index q) {
    const double u = std::numeric_limits<double>::epsilon();
    const double gamma = static_cast<double>(q + 2) * u;  // one more for this line's own rounding
    return gamma / (1 - 3 * gamma);
}

}  // namespace proof_detail

/// Proves symmetric matrices positive definite, rounding included: a floating-point Cholesky
/// factorisation of A − cI that runs to completion, with c above all that rounding can hide
/// (S. M. Rump, Verification of positive definiteness, BIT 2006) [T22].
///
/// A is first scaled to a diagonal near one by powers of two, which is exact and keeps
/// definiteness. The pattern is analysed once for matrices that share it.
class Prover {
public:
    /// @param A          symmetric, both triangles, one pattern for all calls; overwritten
    /// @param max_error  max_error(s): a bound on max_i Σ_j s_i |E_ij| s_j, where E are the errors
    ///                   with which A was formed and s > 0 a scaling of its rows and columns
    template <class Error>
    DefinitenessProof operator()(SparseMatrix<double>&& A, Error&& max_error);
    /// Spent by all calls.
    int factorizations() const { return factorizations_; }
    /// Patterns analysed: one, whatever the number of calls.
    int analyses() const { return analyses_; }

private:
    EigenCholesky cholesky_;
    Index widest_ = 0;  // most nonzeros in a row of the factor; 0: not analysed yet
    int factorizations_ = 0;
    int analyses_ = 0;
};

template <class Error>
DefinitenessProof Prover::operator()(SparseMatrix<double>&& A, Error&& max_error) {
    DefinitenessProof proof;
    const Index N = A.rows();
    Eigen::VectorXd scale(N);
    const Eigen::VectorXd diagonal = A.diagonal();
    for (Index i = 0; i < N; ++i) {
        if (!(diagonal[i] > 0) || !detail::is_finite(diagonal[i])) return proof;
        scale[i] = std::exp2(-(std::round)(std::log2(diagonal[i]) / 2));
    }
    for (Index j = 0; j < N; ++j) {
        for (SparseMatrix<double>::InnerIterator entry(A, j); entry; ++entry) {
            entry.valueRef() = scale[entry.row()] * entry.value() * scale[j];
        }
    }
    if (widest_ == 0) {
        widest_ = cholesky_.analyze(A);
        ++analyses_;
    }

    const double u = std::numeric_limits<double>::epsilon();
    const double sum_rounding = 1 + static_cast<double>(N) * u;
    const double trace = A.diagonal().sum() * sum_rounding;
    const double slack = max_error(scale) * sum_rounding;
    // The last two terms: rounding of A − cI on a diagonal below 4, and underflow.
    const double underflow =
        static_cast<double>(N * (widest_ + 1)) * (std::numeric_limits<double>::min)();
    proof.shift = (slack + proof_detail::cholesky_rounding(widest_) * trace) * (1 + 8 * u) + 4 * u +
                  underflow;
    if (!(proof.shift < 0.5)) return proof;
    A.diagonal().array() -= proof.shift;
    ++factorizations_;
    proof.proved = cholesky_.factorize(A);
    if (proof.proved) proof.least_pivot = cholesky_.least_pivot();
    return proof;
}

/// Proves a matrix that is given exactly, as its stored numbers stand.
template <class Real = double>  // a template, as the others below: only its callers compile it
DefinitenessProof proves_positive_definite(const SparseMatrix<double>& A) {
    return Prover{}(SparseMatrix<double>(A), [](const Eigen::VectorXd&) { return 0.0; });
}

/// Proves the combination S of a pencil, the rounding of its assembly counted.
template <class Real = double>
DefinitenessProof prove(Prover& prover, const Pencil& pencil, const Combination& c) {
    return prover(pencil.assemble_least(c),
                  [&](const Eigen::VectorXd& scale) { return pencil.assembly_error(c, scale); });
}

/// An ε ≥ 0, in the units of M⁻¹S, with S ⪰ −εM proved by factorisation of S + εM: the smallest
/// that rounding allows, within a factor of 16; infinity when none up to `most` is.
template <class Real = double>
double proved_deficit(Prover& prover, const Pencil& pencil, const Combination& c, double most) {
    if (!(most > 0) || !detail::is_finite(most)) return std::numeric_limits<double>::infinity();
    for (double epsilon = 1e-14 * most; epsilon <= most; epsilon *= 16) {
        if (prove(prover, pencil, c + epsilon * matrices::M).proved) return epsilon;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace taut
