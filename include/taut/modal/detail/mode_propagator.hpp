// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace taut::integrator_detail {

/// The exact motion of q̈ + d q̇ + k q = p over one step, p constant [T32]:
///     (q⁺, q̇⁺) = A (q, q̇) + p·b,   A = e^(hC),  b = ∫₀ʰ e^(tC) dt·(0, 1),  C = [0 1; −k −d].
struct ModePropagator {
    double a11, a12, a21, a22;
    double b1, b2;

    /// Closed forms of the roots of λ² + dλ + k, real or complex: their powers keep |μ| = |e^(hλ)|
    /// at any h. A short step and nearly equal roots, where they cancel, go by a series.
    static ModePropagator over(double h, double k, double d) {
        const double rate = std::sqrt((std::abs)(k)) + (std::abs)(d);  // 1/s, of the scaled C
        const double quarter = d * d / 4 - k;                          // of the discriminant
        if (!(rate * h > 0.5) || (std::abs)(quarter) < 1e-2 * rate * rate) {
            return by_series(h, k, d, rate);
        }
        return quarter > 0 ? of_real_roots(h, k, d, std::sqrt(quarter))
                           : of_complex_roots(h, k, d, std::sqrt(-quarter));
    }

private:
    static ModePropagator of_complex_roots(double h, double k, double d, double frequency) {
        const double decay = std::exp(-d / 2 * h);
        const double c = decay * std::cos(frequency * h);
        const double s = decay * std::sin(frequency * h) / frequency;
        const double a11 = c + d / 2 * s;
        return {a11, s, -k * s, c - d / 2 * s, (1 - a11) / k, s};
    }

    static ModePropagator of_real_roots(double h, double k, double d, double half_gap) {
        const double fast = -(d / 2 + std::copysign(half_gap, d));
        const double slow = k / fast;
        const double gap = slow - fast;
        const double e_fast = std::exp(fast * h);
        const double e_slow = std::exp(slow * h);
        const double integral = slow == 0 ? h : std::expm1(slow * h) / slow;
        const double a12 = (e_slow - e_fast) / gap;
        return {(slow * e_fast - fast * e_slow) / gap,
                a12,
                -k * a12,
                (slow * e_slow - fast * e_fast) / gap,
                (integral - std::expm1(fast * h) / fast) / gap,
                a12};
    }

    /// Over h/2^m, and m doublings A(2t) = A², b(2t) = b + A b.
    static ModePropagator by_series(double h, double k, double d, double rate) {
        int doublings = 0;
        double t = h;
        for (; rate * t > 0.5 && doublings < 1000; t /= 2) ++doublings;

        // Row n of the series is (q, q̇) after n derivatives, for the starts (1, 0) and (0, 1).
        ModePropagator m{1, 0, 0, 1, 0, 0};
        double u1 = 1, v1 = 0, u2 = 0, v2 = 1;
        double factor = 1;  // tⁿ/n!
        for (int n = 1; n <= 16; ++n) {
            m.b1 += factor * t / n * u2;  // the integral lags by one power of t
            m.b2 += factor * t / n * v2;
            factor *= t / n;
            const double next1 = -k * u1 - d * v1;
            const double next2 = -k * u2 - d * v2;
            u1 = v1;
            v1 = next1;
            u2 = v2;
            v2 = next2;
            m.a11 += factor * u1;
            m.a21 += factor * v1;
            m.a12 += factor * u2;
            m.a22 += factor * v2;
        }
        for (int i = 0; i < doublings; ++i) m = m.twice();
        return m;
    }
    ModePropagator twice() const {
        return {a11 * a11 + a12 * a21, a11 * a12 + a12 * a22,    a21 * a11 + a22 * a21,
                a21 * a12 + a22 * a22, b1 + a11 * b1 + a12 * b2, b2 + a21 * b1 + a22 * b2};
    }
};

}  // namespace taut::integrator_detail
