// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../core/detail/finite.hpp"

namespace taut::proof_detail {

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
inline bool proved_above(const SymmetricBlock& A, double sigma) {
    if (!(sigma > 1e-150 && sigma < 1e150)) return false;
    const double margin = 64 * std::numeric_limits<double>::epsilon() * sigma;
    SymmetricBlock L;
    for (int e = 0; e < 6; ++e) L.entry[e] = -A.entry[e];
    for (int j = 0; j < 3; ++j) L(j, j) += sigma - margin;
    for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < j; ++k) L(j, j) -= L(j, k) * L(j, k);
        if (!(L(j, j) > 0)) return false;
        L(j, j) = std::sqrt(L(j, j));
        for (int i = j + 1; i < 3; ++i) {
            for (int k = 0; k < j; ++k) L(i, j) -= L(i, k) * L(j, k);
            L(i, j) /= L(j, j);
        }
    }
    return detail::is_finite(L.trace());  // else no comparison above is one
}

/// The largest eigenvalue of a symmetric 3 × 3 matrix by the cosine formula: good to about √eps of
/// its norm, so an estimate only.
inline double cosine_eigenvalue(const SymmetricBlock& A) {
    const double mean = A.trace() / 3;
    const double off = A(1, 0) * A(1, 0) + A(2, 0) * A(2, 0) + A(2, 1) * A(2, 1);
    const double a = A(0, 0) - mean;
    const double b = A(1, 1) - mean;
    const double c = A(2, 2) - mean;
    const double p = std::sqrt((a * a + b * b + c * c + 2 * off) / 6);
    if (p <= 1e-8 * (std::abs)(mean)) return mean + 2 * p;  // never below, and p³ may vanish
    const double det = a * (b * c - A(2, 1) * A(2, 1)) -
                       A(1, 0) * (A(1, 0) * c - A(2, 1) * A(2, 0)) +
                       A(2, 0) * (A(1, 0) * A(2, 1) - b * A(2, 0));
    const double r = std::clamp(det / (2 * p * p * p), -1.0, 1.0);
    return mean + 2 * p * std::cos(std::acos(r) / 3);
}

/// A proved upper bound on the largest eigenvalue of a symmetric positive semi-definite matrix of
/// `dim` rows, within 1e-6 of it relative to the norm.
inline double eigenvalue_upper_bound(const SymmetricBlock& A, int dim) {
    constexpr double margin = 1 + 64 * std::numeric_limits<double>::epsilon();
    const double trace = A.trace() * margin;  // a bound too, since no eigenvalue is negative
    if (dim == 1) return trace;
    if (!detail::is_finite(trace)) return std::numeric_limits<double>::infinity();
    if (!(trace > 0)) return 0;
    if (!(trace > 1e-90 && trace < 1e90)) {
        // Squares and cubes would vanish or overflow; powers of two cost nothing.
        const int exponent = std::ilogb(trace);
        SymmetricBlock scaled;
        for (int e = 0; e < 6; ++e) scaled.entry[e] = std::scalbn(A.entry[e], -exponent);
        return std::scalbn(eigenvalue_upper_bound(scaled, dim), exponent);
    }
    const double sigma =
        dim == 2 ? (A(0, 0) + A(1, 1)) / 2 + std::hypot((A(0, 0) - A(1, 1)) / 2, A(1, 0))
                 : cosine_eigenvalue(A);
    for (double slack = 1e-12; slack < 2e-6; slack *= 100) {
        const double candidate = sigma * (1 + slack);
        if (candidate < trace && proved_above(A, candidate)) return candidate;
    }
    return trace;
}

}  // namespace taut::proof_detail
