// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "exact_system.hpp"

// Whether explicit Euler fails at a step, by all of its multipliers: for dampers, where no one
// matrix tells.

namespace soundness {

/// How many roots of Σ c_j s^j have a positive real part, by Routh's array; nothing where an
/// element of its first column cannot be told from zero.
inline std::optional<int> right_half_plane(const std::vector<Real>& c) {
    std::vector<Real> above, row;
    for (std::size_t j = c.size(); j-- > 0;)
        ((c.size() - 1 - j) % 2 == 0 ? above : row).push_back(c[j]);
    int changes = 0;
    while (!row.empty()) {
        changes += (above[0] > 0) != (row[0] > 0);
        std::vector<Real> next;
        const Real ratio = above[0] / row[0];
        for (std::size_t j = 1; j < above.size(); ++j) {
            const Real other = j < row.size() ? Real(ratio * row[j]) : Real(0);
            next.push_back(above[j] - other);
            const Real size = abs(above[j]) + abs(other);
            if (j == 1 && abs(next[0]) <= scaled(size, -bits() / 3)) return std::nullopt;
        }
        above = std::move(row);
        row = std::move(next);
    }
    return changes;
}

/// The exponent of a unit of time, 2^p s, in which the largest entries of M⁻¹K and M⁻¹D are about
/// 1: in others, coefficients that differ by their unit alone would be taken for zero.
inline long time_unit(const Exact& e) {
    const Matrix K = Sum(e).stiffness(1).matrix().value;
    const Matrix D = Sum(e).damping(1).matrix().value;
    Real fastest = 0;
    for (int i = 0; i < e.size(); ++i) {
        fastest = std::max(fastest, Real(sqrt(abs(K(i, i)) / e.mass[i])));
        fastest = std::max(fastest, Real(abs(D(i, i)) / e.mass[i]));
    }
    return fastest == 0 ? 0 : -static_cast<long>(ilogb(fastest));
}

/// Coefficients of the characteristic polynomial of C = [[0, I], [−M⁻¹K, −M⁻¹D]], that of λⁿ last,
/// by Faddeev and LeVerrier, in a unit of time of 2^unit s. The zero modes' factors λ are divided
/// out.
inline std::vector<Real> characteristic_polynomial(const Exact& e, long unit) {
    const int N = e.size();
    const int n = 2 * N;
    const Matrix K = Sum(e).stiffness(1).matrix().value;
    const Matrix D = Sum(e).damping(1).matrix().value;
    Real norm = 0;
    const auto times_C = [&](const Matrix& B) {
        Matrix result(n);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < N; ++i) {
                result(i, j) = B(N + i, j);
                Real sum = 0;
                for (int k = 0; k < N; ++k) {
                    if (K(i, k) != 0) sum -= scaled(K(i, k), 2 * unit) * B(k, j);
                    if (D(i, k) != 0) sum -= scaled(D(i, k), unit) * B(N + k, j);
                }
                result(N + i, j) = sum / e.mass[i];
            }
        }
        return result;
    };
    std::vector<Real> c(static_cast<std::size_t>(n) + 1);
    c[n] = 1;
    Matrix B(n);
    for (int k = 1; k <= n; ++k) {
        for (int i = 0; i < n; ++i) B(i, i) += c[n - k + 1];
        B = times_C(B);
        Real trace = 0;
        Real size = 0;
        for (int i = 0; i < n; ++i) {
            trace += B(i, i);
            for (int j = 0; j < n; ++j) size = std::max(size, Real(abs(B(i, j))));
        }
        c[n - k] = -trace / k;
        norm = std::max(norm, size);
        if (abs(c[n - k]) <= scaled(norm, -bits() / 2)) c[n - k] = 0;
    }
    std::size_t zeros = 0;
    while (c[zeros] == 0) ++zeros;
    c.erase(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(zeros));
    return c;
}

/// Whether step h of explicit Euler has a multiplier 1 + hλ outside the circle, zero modes apart:
/// ν = 1/λ must have Re ν < −h/2 for every λ [T18].
/// @returns nothing for many unknowns, and where K is not known to be positive semi-definite
inline std::optional<bool> unstable_explicit(const Exact& coarse, const Real& h) {
    constexpr int most_unknowns = 9;
    constexpr long most_bits = 6000;
    if (coarse.size() > most_unknowns || !coarse.again) return std::nullopt;
    if (negative(Sum(coarse).stiffness(1).matrix()) != Answer::no) return std::nullopt;
    const unsigned before = Real::default_precision();
    const long coarse_bits = bits();
    const long needed = 512 + 4L * coarse.size() * spread_by_mass(coarse);
    if (needed > most_bits) return std::nullopt;
    set_bits(std::max(needed, coarse_bits));
    const Exact fine = coarse.again();
    const long unit = time_unit(fine);
    const std::vector<Real> c = characteristic_polynomial(fine, unit);
    // c reversed is the polynomial of ν; Horner's scheme shifts it to s = ν + h/2.
    std::vector<Real> shifted(c.rbegin(), c.rend());
    const Real half = scaled(Real(h), -unit) / 2;
    for (std::size_t i = 0; i + 1 < shifted.size(); ++i) {
        for (std::size_t j = shifted.size() - 1; j-- > i;) shifted[j] -= half * shifted[j + 1];
    }
    const auto outside = shifted.size() < 2 ? std::optional<int>(0) : right_half_plane(shifted);
    Real::default_precision(before);
    if (!outside) return std::nullopt;
    return *outside > 0;
}

}  // namespace soundness
