// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <boost/multiprecision/mpfr.hpp>
#include <cmath>
#include <cstddef>
#include <vector>

// Whether a symmetric matrix is positive definite, or has a negative direction: both by proof, in
// as many bits as it takes, with no range to overflow.

namespace soundness {

/// A binary number of `bits()` bits; MPFR's exponents have 62 bits.
using Real = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<0>,
                                           boost::multiprecision::et_off>;

/// Every Real made from now on has at least so many bits.
inline void set_bits(long bits) {
    Real::default_precision(static_cast<unsigned>(bits * 302 / 1000 + 2));
}
inline long bits() { return static_cast<long>(Real::default_precision()) * 1000 / 302 - 8; }
/// value·2^exponent
inline Real scaled(const Real& value, long exponent) {
    Real result;
    mpfr_mul_2si(result.backend().data(), value.backend().data(), exponent, MPFR_RNDN);
    return result;
}
/// The binary exponent of a number other than 0.
inline long exponent(const Real& value) {
    return static_cast<long>(mpfr_get_exp(value.backend().data()));
}

/// A square matrix, row by row.
class Matrix {
public:
    explicit Matrix(int n = 0) : n_(n), a_(static_cast<std::size_t>(n) * n) {}
    int size() const { return n_; }
    Real& operator()(int i, int j) { return a_[static_cast<std::size_t>(i) * n_ + j]; }
    const Real& operator()(int i, int j) const { return a_[static_cast<std::size_t>(i) * n_ + j]; }

private:
    int n_;
    std::vector<Real> a_;
};

/// A symmetric matrix as computed. Entry (i, j) of the exact one differs by at most
/// 2^(10 − bits())·magnitude(i, j).
struct Rounded {
    Matrix value;
    Matrix magnitude;

    explicit Rounded(int n = 0) : value(n), magnitude(n) {}
    int size() const { return value.size(); }
};

enum class Answer { no, yes, unknown };

namespace detail {

/// A diagonal that outweighs what is uncertain of A and the rounding errors of its factorisation:
/// with γ = 2^(10 − bits()) and t_i = 1/√magnitude(i, i), the matrix of the errors scaled by t has
/// rows of at most γ·Σ_j magnitude(i, j)·t_j/t_i, and so less than this on both counts.
inline std::vector<Real> slack(const Rounded& A) {
    const int n = A.size();
    std::vector<Real> root(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
        Real size = A.magnitude(i, i);
        for (int j = 0; size == 0 && j < n; ++j) size = A.magnitude(i, j);
        root[i] = size == 0 ? Real(1) : Real(sqrt(size));
    }
    std::vector<Real> diagonal(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
        Real sum = 0;
        for (int j = 0; j < n; ++j) {
            if (A.magnitude(i, j) != 0) sum += A.magnitude(i, j) / root[j];
        }
        diagonal[i] = sum == 0 ? Real(1) : scaled(sum * root[i], 18 - bits());
    }
    return diagonal;
}

/// A = LDLᵀ in place: D on the diagonal, L below. @returns the first pivot that is not positive, or
/// n. Up to there A's leading block is positive definite, so nothing grows: the rounding errors are
/// at most 2nu√(a_ii a_jj), u = 2^-bits().
inline int factorise(Matrix& A) {
    const int n = A.size();
    std::vector<Real> column(static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k) {
        if (!(A(k, k) > 0)) return k;
        for (int i = k + 1; i < n; ++i) {
            column[i] = -A(i, k);
            if (column[i] == 0) continue;
            A(i, k) /= A(k, k);
            for (int j = k + 1; j <= i; ++j) {
                if (column[j] == 0) continue;
                auto* entry = A(i, j).backend().data();
                mpfr_fma(entry, A(i, k).backend().data(), column[j].backend().data(), entry,
                         MPFR_RNDN);
            }
        }
    }
    return n;
}

}  // namespace detail

/// Whether A ≻ 0 is proved.
inline bool positive(const Rounded& A) {
    Matrix F = A.value;
    const auto diagonal = detail::slack(A);
    for (int i = 0; i < F.size(); ++i) F(i, i) -= diagonal[i];
    return detail::factorise(F) == F.size();
}

/// Whether some u has uᵀAu < 0. No: A ⪰ −(a diagonal of some 2^-bits() of A's own) is proved.
inline Answer negative(const Rounded& A) {
    const int n = A.size();
    Matrix F = A.value;
    const auto diagonal = detail::slack(A);
    for (int i = 0; i < n; ++i) F(i, i) += diagonal[i];
    const int failed = detail::factorise(F);
    if (failed == n) return Answer::no;
    // Lᵀu = e on the leading block gives uᵀFu = the pivot. What uᵀAu is, is computed anew.
    std::vector<Real> u(static_cast<std::size_t>(failed) + 1);
    u[failed] = 1;
    for (int i = failed - 1; i >= 0; --i) {
        for (int j = i + 1; j <= failed; ++j) u[i] -= F(j, i) * u[j];
    }
    Real form = 0;
    Real error = 0;
    for (int i = 0; i <= failed; ++i) {
        for (int j = 0; j <= failed; ++j) {
            const Real weight = u[i] * u[j];
            form += weight * A.value(i, j);
            error += abs(weight) * A.magnitude(i, j);
        }
    }
    return form < -scaled(error, 12 - bits()) ? Answer::yes : Answer::unknown;
}

}  // namespace soundness
