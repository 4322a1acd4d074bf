// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/assert.hpp"

namespace taut::stability_detail {

/// A symmetric matrix of up to three rows: the columns of its lower triangle, zero beyond its
/// dimension.
struct SymmetricBlock {
    double entry[6] = {0, 0, 0, 0, 0, 0};

    /// Of row i and column j ≤ i.
    double& operator()(int i, int j) { return entry[i + j * (5 - j) / 2]; }
    double operator()(int i, int j) const { return entry[i + j * (5 - j) / 2]; }
    double trace() const { return entry[0] + (entry[3] + entry[5]); }
};

/// Whether σI − A is positive definite for certain: a Cholesky factorisation whose pivots stay
/// above the rounding it can have committed [T22]. False where squares of σ vanish or overflow.
bool proved_above(const SymmetricBlock& A, double sigma);

/// The largest eigenvalue of a symmetric 3 × 3 matrix by the cosine formula: good to about √eps of
/// its norm, so an estimate only.
double cosine_eigenvalue(const SymmetricBlock& A);

/// A proved upper bound on the largest eigenvalue of a symmetric positive semi-definite matrix of
/// `dim` rows, within 1e-6 of it relative to the norm.
double eigenvalue_upper_bound(const SymmetricBlock& A, int dim);

}  // namespace taut::stability_detail

#if !defined(TAUT_COMPILED)
#include "small_eigenvalue-inl.hpp"
#endif
