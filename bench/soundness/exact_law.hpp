// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/network/buckling.hpp>
#include <taut/network/hookean.hpp>
#include <taut/network/tension_only.hpp>

#include "definite.hpp"

// The spring laws in the referee's numbers, from the equations of docs/theory.

namespace soundness {

/// One spring at length l > 0.
struct Tangent {
    Real tension;    ///< N
    Real slope;      ///< T′, N/m
    Real magnitude;  ///< N/m: what the rounding errors of T′ and T/l are relative to
};

inline Tangent law_tangent(taut::Hookean, const taut::Hookean::Parameters<Real>& p, const Real& L,
                           const Real& l) {
    const Real& k = p.stiffness;
    return {k * (l - L), k, k * (1 + L / l)};
}
inline Real law_bound(taut::Hookean, const taut::Hookean::Parameters<Real>& p, const Real&) {
    return p.stiffness;
}

inline Tangent law_tangent(taut::TensionOnly, const taut::Hookean::Parameters<Real>& p,
                           const Real& L, const Real& l) {
    const Real& k = p.stiffness;
    const Real magnitude = k * (1 + L / l);
    return l > L ? Tangent{k * (l - L), k, magnitude} : Tangent{0, 0, magnitude};
}
inline Real law_bound(taut::TensionOnly, const taut::Hookean::Parameters<Real>& p, const Real&) {
    return p.stiffness;
}

/// A circular arc over a chord, w the square of half its angle [T30]: A = (1 − sinc √w)/w and
/// B = (sinc √w − cos √w)/w as power series, which lose nothing for flat arcs.
struct Arc {
    Real w;
    Real A = 0;
    Real B = 0;
    Real slope = 0;  ///< B′(w)

    explicit Arc(const Real& at) : w(at) {
        Real term = Real(1) / 6;  // (−1)^m w^m/(2m + 3)!
        Real before = 0;          // the same without one w
        for (long m = 0; m < 10000; ++m) {
            A += term;
            B += (2 * m + 2) * term;
            slope += m * (2 * m + 2) * before;
            if (m > 4 && abs(term) * m * m < scaled(Real(1), -bits() - 16)) break;
            before = -term / ((2 * m + 4) * (2 * m + 5));
            term = before * w;
        }
    }
    /// 1 − l/L = w·A(w) by bisection in double, then by Newton; its derivative is B/2.
    static Arc shortened(const Real& delta) {
        const auto target = static_cast<double>(delta);
        double low = 0;
        double high = M_PI;
        for (int i = 0; i < 60; ++i) {
            const double y = (low + high) / 2;
            (1 - std::sin(y) / y < target ? low : high) = y;
        }
        Arc arc{Real(low) * low};
        for (int i = 0; i < 100; ++i) {
            const Real step = 2 * (arc.w * arc.A - delta) / arc.B;
            arc = Arc(arc.w - step);
            if (abs(step) <= scaled(Real(1), -bits())) break;
        }
        return arc;
    }
};

inline Real beam_unit(const taut::Buckling::Parameters<Real>& p, const Real& L) {
    return p.bending / (L * L);
}

/// The law for l < L: the line or the beam, whichever pushes less.
inline Tangent pushed(const taut::Buckling::Parameters<Real>& p, const Real& L, const Real& l) {
    const Real unit = beam_unit(p, L);
    const Real line = p.onset * (l - L);
    const Real magnitude = (p.onset + 256 * unit / L) * (1 + L / l);
    if (line >= -12 * unit && unit > 0) return {line, p.onset, magnitude};
    const Arc arc = Arc::shortened((L - l) / L);
    const Real beam = -4 * unit / arc.B;
    const Real slope = -8 * unit * arc.slope / (L * arc.B * arc.B * arc.B);
    return line >= beam ? Tangent{line, p.onset, magnitude} : Tangent{beam, slope, magnitude};
}

inline Tangent law_tangent(taut::Buckling, const taut::Buckling::Parameters<Real>& p, const Real& L,
                           const Real& l) {
    if (l < L) return pushed(p, L, l);
    return {p.stiffness * (l - L), p.stiffness, p.stiffness * (1 + L / l)};
}
/// The beam is stiffest where its ends touch, T′ = 12π²k_b/L³, if it ever pushes less than the
/// line, which is so where c_b > 31.4711 k_b/L³.
inline Real law_bound(taut::Buckling, const taut::Buckling::Parameters<Real>& p, const Real& L) {
    Real bound = std::max(p.stiffness, p.onset);
    if (L == 0) return bound;
    const Real unit = beam_unit(p, L) / L;
    if (p.onset * 10000 <= 314712 * unit) return bound;
    Real pi;
    mpfr_const_pi(pi.backend().data(), MPFR_RNDN);
    return std::max(bound, Real(12 * pi * pi * unit));
}

}  // namespace soundness
