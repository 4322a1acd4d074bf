// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "complex_multipliers.hpp"

// What a limit claims (docs/theory, damping and certified), and whether it is false. A claim
// is called wrong on a proof alone; where neither side can be shown it is unknown.

namespace soundness {

enum class Verdict { holds, wrong, unknown };

inline Verdict wrong_if(Answer answer) {
    return answer == Answer::yes  ? Verdict::wrong
           : answer == Answer::no ? Verdict::holds
                                  : Verdict::unknown;
}
/// The worse of two.
inline Verdict both(Verdict a, Verdict b) {
    if (a == Verdict::wrong || b == Verdict::wrong) return Verdict::wrong;
    return a == Verdict::holds ? b : a;
}

/// 4M − 2hD − h²K [T19]
inline Rounded symplectic_matrix(const Exact& e, const Real& h) {
    return Sum(e).mass(4).damping(-2 * h).stiffness(-h * h).matrix();
}
/// 4M − 2hD + h²K [T17]
inline Rounded explicit_matrix(const Exact& e, const Real& h) {
    return Sum(e).mass(4).damping(-2 * h).stiffness(h * h).matrix();
}

/// Whether 4y²M − 2yD − K has a negative direction at a y in [low, high]: it is matrix-convex in y,
/// so that its tangent at the middle, definite at both ends, excludes one.
inline Verdict negative_between(const Exact& e, const Real& low, const Real& high, int depth = 0) {
    const Real y = (low + high) / 2;
    const auto tangent = [&](const Real& at) {
        const Real by = at - y;
        return positive(
            Sum(e).mass(4 * y * y + 8 * y * by).damping(-2 * y - 2 * by).stiffness(-1).matrix());
    };
    const Verdict here =
        wrong_if(negative(Sum(e).mass(4 * y * y).damping(-2 * y).stiffness(-1).matrix()));
    if (here == Verdict::wrong) return here;
    if (tangent(low) && tangent(high)) return Verdict::holds;
    if (depth == 10) return Verdict::unknown;
    return both(negative_between(e, low, y, depth + 1), negative_between(e, y, high, depth + 1));
}

/// No step in (0, h] has a real multiplier < −1 of symplectic Euler. A negative direction of
/// 4M − 2hD − h²K is one at h; where K or D is indefinite it may be there at smaller steps only.
inline Verdict certified_symplectic(const Exact& e, const Real& h) {
    const Verdict here = wrong_if(negative(symplectic_matrix(e, h)));
    if (here != Verdict::holds) return here;
    if (negative(Sum(e).stiffness(1).matrix()) == Answer::no) return here;
    if (positive(Sum(e).mass(4).damping(-h).matrix())) return here;
    Real last = 1 / h;  // above it 4y²M − 2yD − K increases
    for (int i = 0; i < 400 && !positive(Sum(e).mass(8 * last).damping(-2).matrix()); ++i)
        last *= 2;
    Verdict all = here;
    for (Real y = 1 / h; y < last && all != Verdict::wrong; y *= 2)
        all = both(all, negative_between(e, y, 2 * y));
    return all;
}
/// Without K or D pulling or braking anywhere, every step is stable.
inline Verdict certified_always(const Exact& e) {
    return both(wrong_if(negative(Sum(e).stiffness(-1).matrix())),
                wrong_if(negative(Sum(e).damping(-1).matrix())));
}
/// Explicit Euler sees a K or D that pushes, too: 4M − 2hD + h²K fails at a large h.
inline Verdict certified_always_explicit(const Exact& e) {
    return both(certified_always(e), both(wrong_if(negative(Sum(e).stiffness(1).matrix())),
                                          wrong_if(negative(Sum(e).damping(1).matrix()))));
}
/// Step h of symplectic Euler has a real multiplier ≤ −1.
inline Verdict refuted_symplectic(const Exact& e, const Real& h) {
    return positive(symplectic_matrix(e, h)) ? Verdict::wrong : Verdict::holds;
}

/// Steps in (0, h] of explicit Euler are stable but for zero modes and the growth of the physics.
/// The proof is D − hK ⪰ 0 beside 4M − 2hD + h²K ≻ 0 [T17]; where only the first fails, and D is
/// no Rayleigh damping, the claim stands without proof but may be true: the multipliers tell.
/// @param admitted  δ, 1/s: D − hK ⪰ −δM is what was claimed
inline Verdict certified_explicit(const Exact& e, const Real& h, const Real& admitted) {
    return both(wrong_if(negative(explicit_matrix(e, h))),
                wrong_if(negative(Sum(e).damping(1).stiffness(-h).mass(admitted).matrix())));
}
/// Some step in (0, h] of explicit Euler fails. Wrong where [T17] proves that the step a trifle
/// above h is stable, or where none of its multipliers is outside the circle.
inline Verdict refuted_explicit(const Exact& e, const Real& h) {
    const Real above = h * (1 + scaled(Real(1), -48));
    if (!positive(explicit_matrix(e, above))) return Verdict::holds;
    const Rounded first = Sum(e).damping(1).stiffness(-above).matrix();
    if (negative(first) == Answer::no) return Verdict::wrong;
    const bool commutes = is_zero(e.dampers) && (e.alpha == 0 || is_same(e.K, e.K_plus));
    if (commutes) return Verdict::holds;
    const auto fails = unstable_explicit(e, above);
    return !fails ? Verdict::unknown : *fails ? Verdict::holds : Verdict::wrong;
}

/// Every step in (0, h] of implicit Euler can be solved for: M + hD + h²K⁺ ≻ 0 [T21], [T27].
inline Verdict certified_implicit(const Exact& e, const Real& h) {
    return wrong_if(negative(Sum(e).mass(1).damping(h).projected(h * h).matrix()));
}
inline Verdict refuted_implicit(const Exact& e, const Real& h) {
    return positive(Sum(e).mass(1).damping(h).projected(h * h).matrix()) ? Verdict::wrong
                                                                         : Verdict::holds;
}

/// M − h²K − ½hD [T42]: positive semi-definite up to the limit of EnergyStableEuler.
inline Rounded energy_stable_matrix(const Exact& e, const Real& h) {
    return Sum(e).mass(1).damping(-h / 2).stiffness(-h * h).matrix();
}
inline Verdict certified_energy_stable(const Exact& e, const Real& h) {
    return wrong_if(negative(energy_stable_matrix(e, h)));
}
inline Verdict refuted_energy_stable(const Exact& e, const Real& h) {
    return positive(energy_stable_matrix(e, h)) ? Verdict::wrong : Verdict::holds;
}

/// K ⪰ −rate²·M; of springs but for what rounding a rest length and a length comes to.
inline Verdict no_faster_growth(const Exact& e, const Real& rate) {
    Sum sum(e);
    sum.stiffness(1).mass(rate * rate);
    if (e.springs) sum.bound(scaled(Real(1), -46));
    return wrong_if(negative(sum.matrix()));
}
/// D ⪰ −rate·M.
inline Verdict no_faster_feeding(const Exact& e, const Real& rate) {
    return wrong_if(negative(Sum(e).damping(1).mass(rate).matrix()));
}
/// K has a negative direction.
inline Verdict buckles(const Exact& e) {
    return negative(Sum(e).stiffness(1).matrix()) == Answer::no ? Verdict::wrong : Verdict::holds;
}

}  // namespace soundness
