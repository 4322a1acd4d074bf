// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "../../core/types.hpp"

// The eigenvalues of the small matrices that a Lanczos search projects on. Plain loops: compiling
// Eigen's solver takes longer than all else that a step limit needs.

namespace taut::proof_detail {

/// Eigenvalues of a symmetric m × m matrix, ascending, and its eigenvectors, or some of their rows.
struct SmallSpectrum {
    std::vector<double> values;   // m
    std::vector<double> vectors;  // r × m, by columns

    const double* vector(Index j) const { return vectors.data() + j * rows(); }
    Index rows() const { return static_cast<Index>(vectors.size() / values.size()); }
};

/// One sweep of QL with an implicit shift over the rows `first` to `last` of a tridiagonal matrix
/// that does not fall apart between them.
/// @param d, e     its diagonal and what stands beside it
/// @param rotate   rotate(i, c, s): columns i and i + 1 of the eigenvectors
template <class Rotate>
void ql_sweep(std::vector<double>& d, std::vector<double>& e, std::size_t first, std::size_t last,
              Rotate&& rotate) {
    const double half = (d[first + 1] - d[first]) / (2 * e[first]);
    double g = d[last] - d[first] + e[first] / (half + std::copysign(std::hypot(half, 1), half));
    double c = 1;
    double s = 1;
    double shift = 0;
    for (std::size_t i = last; i-- > first;) {
        const double f = s * e[i];
        const double b = c * e[i];
        const double r = std::hypot(f, g);
        e[i + 1] = r;
        if (r == 0) {  // it fell apart here
            d[i + 1] -= shift;
            e[last] = 0;
            return;
        }
        s = f / r;
        c = g / r;
        g = d[i + 1] - shift;
        const double t = (d[i] - g) * s + 2 * c * b;
        shift = s * t;
        d[i + 1] = g + shift;
        g = c * t - b;
        rotate(i, c, s);
    }
    d[first] -= shift;
    e[first] = g;
    e[last] = 0;
}

/// The spectrum of a symmetric tridiagonal matrix (H. Bowdler, R. S. Martin, C. Reinsch and
/// J. H. Wilkinson, The QR and QL algorithms for symmetric matrices, 1968).
/// @param d, e  its diagonal, m, and what stands beside it, m − 1
/// @param V     r × m, by columns: what the eigenvectors are multiplied by from the left
inline SmallSpectrum tridiagonal_spectrum(std::vector<double> d, std::vector<double> e,
                                          std::vector<double> V) {
    constexpr int most_sweeps = 60;  // a row: a handful is usual, what is not finite never ends
    constexpr double eps = std::numeric_limits<double>::epsilon();
    const std::size_t m = d.size();
    const std::size_t rows = V.size() / m;
    e.resize(m, 0);
    const auto rotate = [&](std::size_t i, double c, double s) {
        double* low = V.data() + i * rows;
        double* high = low + rows;
        for (std::size_t k = 0; k < rows; ++k) {
            const double old = high[k];
            high[k] = s * low[k] + c * old;
            low[k] = c * low[k] - s * old;
        }
    };
    for (std::size_t first = 0; first < m; ++first) {
        for (int sweep = 0; sweep < most_sweeps; ++sweep) {
            std::size_t last = first;
            while (last + 1 < m &&
                   !((std::abs)(e[last]) <= eps * ((std::abs)(d[last]) + (std::abs)(d[last + 1]))))
                ++last;
            if (last == first) break;
            ql_sweep(d, e, first, last, rotate);
        }
    }
    std::vector<std::size_t> order(m);
    for (std::size_t j = 0; j < m; ++j) order[j] = j;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return d[a] < d[b]; });
    SmallSpectrum spectrum;
    for (const std::size_t j : order) {
        spectrum.values.push_back(d[j]);
        const auto column = V.begin() + static_cast<std::ptrdiff_t>(j * rows);
        spectrum.vectors.insert(spectrum.vectors.end(), column,
                                column + static_cast<std::ptrdiff_t>(rows));
    }
    return spectrum;
}

/// The identity, m × m.
inline std::vector<double> small_identity(std::size_t m) {
    std::vector<double> V(m * m, 0);
    for (std::size_t j = 0; j < m; ++j) V[j * m + j] = 1;
    return V;
}

/// The spectrum of a symmetric matrix, m × m by columns: Householder's reduction, and QL.
inline SmallSpectrum small_spectrum(std::vector<double> A, std::size_t m) {
    double scale = 0;
    for (const double a : A) scale = (std::max)(scale, (std::abs)(a));
    if (!(scale > 0)) scale = 1;
    for (double& a : A) a /= scale;
    std::vector<double> V = small_identity(m);
    std::vector<double> v(m);
    std::vector<double> w(m);
    // w ← S v for m × m matrices by columns.
    const auto times = [m](const std::vector<double>& S, const std::vector<double>& x,
                           std::vector<double>& y) {
        std::fill(y.begin(), y.end(), 0);
        for (std::size_t j = 0; j < m; ++j) {
            for (std::size_t i = 0; i < m; ++i) y[i] += S[j * m + i] * x[j];
        }
    };
    for (std::size_t k = 0; k + 2 < m; ++k) {
        double square = 0;
        for (std::size_t i = 0; i < m; ++i) {
            v[i] = i <= k ? 0 : A[k * m + i];
            square += v[i] * v[i];
        }
        const double norm = std::sqrt(square);
        if (!(norm > 1e-150)) continue;  // its squares would lose digits, and it changes nothing
        const double pivot = v[k + 1];
        v[k + 1] += pivot < 0 ? -norm : norm;
        const double length = std::sqrt(2 * norm * (norm + (std::abs)(pivot)));
        for (double& entry : v) entry /= length;
        // (I − 2vvᵀ)A(I − 2vvᵀ) = A − vwᵀ − wvᵀ.
        times(A, v, w);
        double along = 0;
        for (std::size_t i = 0; i < m; ++i) along += v[i] * w[i];
        for (std::size_t i = 0; i < m; ++i) w[i] = 2 * (w[i] - along * v[i]);
        for (std::size_t j = 0; j < m; ++j) {
            for (std::size_t i = 0; i < m; ++i) A[j * m + i] -= w[j] * v[i] + v[j] * w[i];
        }
        times(V, v, w);
        for (std::size_t j = 0; j < m; ++j) {
            for (std::size_t i = 0; i < m; ++i) V[j * m + i] -= 2 * v[j] * w[i];
        }
    }
    std::vector<double> d(m);
    std::vector<double> e(m);
    for (std::size_t j = 0; j < m; ++j) {
        d[j] = A[j * m + j];
        e[j] = j + 1 < m ? A[j * m + j + 1] : 0;
    }
    SmallSpectrum spectrum = tridiagonal_spectrum(std::move(d), std::move(e), std::move(V));
    for (double& value : spectrum.values) value *= scale;
    return spectrum;
}

}  // namespace taut::proof_detail
