// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../core/error.hpp"
#include "detail/arc.hpp"
#include "detail/slope_range.hpp"
#include "detail/where_less.hpp"

namespace taut {

/// The bending spring of Choi & Ko, "Stable but responsive cloth", SIGGRAPH 2002: pulled, it is
/// linear; pushed, it answers as a beam that has buckled to a circular arc of its own length,
///
///     T = max(c_b(l − L), k_b κ²/(cos(κL/2) − sinc(κL/2))),  κ = (2/L)·sinc⁻¹(l/L),
/// the derivative of the arc's bending energy ½k_b κ² L [T30]. The beam alone goes from −12k_b/L²
/// at l → L to −4π²k_b/L² at l → 0; the line closes its jump at l = L.
///
/// T′ ≥ 0 at every length, so K⁺ drops the transverse part alone and is positive semi-definite. The
/// beam shows where c_b > 31.5 k_b/L³; a softer line is never exceeded. Not convex: it pushes.
struct Buckling {
    static constexpr bool convex = false;
    static constexpr bool monotone = true;
    static constexpr bool vectorizable = true;

    /// What one spring needs beside its rest length.
    template <class Scalar>
    struct Parameters {
        Scalar stiffness;  ///< when pulled, N/m, ≥ 0
        Scalar bending;    ///< k_b, N·m², ≥ 0
        Scalar onset;      ///< c_b, N/m, ≥ 0; Choi & Ko: of the order of the stiffness

        /// Fails with a message that begins with `where` unless the parameters are in range.
        void require_valid(const char* where) const {
            require_non_negative(where, "stiffness", stiffness);
            require_non_negative(where, "bending", bending);
            require_non_negative(where, "onset", onset);
        }
        /// The parameters in another precision.
        template <class Other>
        Parameters<Other> cast() const {
            return {static_cast<Other>(stiffness), static_cast<Other>(bending),
                    static_cast<Other>(onset)};
        }
    };

    /// T(l), N; negative (pushing) when l < L.
    template <class Real>
    static Real tension(const Parameters<Real>& p, Real L, Real l) {
        using network_detail::where_less;
        const Real line = where_less(l, L, p.onset, p.stiffness) * (l - L);
        const Real beam = beam_tension(p, L, l);
        return where_less(line, beam, beam, line);
    }
    /// T′(l), N/m; at the kinks that of one side.
    template <class Real>
    static Real tension_slope(const Parameters<Real>& p, Real L, Real l) {
        using network_detail::where_less;
        const Real slope = where_less(l, L, p.onset, p.stiffness);
        return where_less(slope * (l - L), beam_tension(p, L, l), beam_slope(p, L, l), slope);
    }
    /// The least and the largest T′ between two lengths, N/m, on both sides of each kink.
    template <class Scalar>
    static std::pair<Scalar, Scalar> slope_range(const Parameters<Scalar>& p, Scalar L, Scalar low,
                                                 Scalar high) {
        auto range = network_detail::slopes_at_ends_and_rest<Buckling>(p, L, low, high);
        if (!(onset_excess(p, L) > 0)) return range;
        // Along the arc T′ falls as l grows, so that its ends and those of the interval decide.
        const auto [from, to] = arc_ends(p, L);
        for (const Scalar delta : {from, to}) {
            const Scalar l = L * (1 - delta);
            if (l >= low && l <= high) network_detail::widen(range, {beam_slope(p, L, l)});
        }
        return range;
    }
    /// Energy, J: along the beam 4k_b/L·∫G + constant, that of bending, and that of the line beside
    /// it.
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        if (l >= L) return Scalar(0.5) * p.stiffness * (l - L) * (l - L);
        const auto line = [&](Scalar shortening) {  // δ = 1 − l/L
            return Scalar(0.5) * p.onset * L * L * shortening * shortening;
        };
        const Scalar delta = (L - l) / L;
        if (!(onset_excess(p, L) > 0)) return line(delta);
        const auto [from, to] = arc_ends(p, L);
        if (delta <= from) return line(delta);
        const Scalar work = Arc<Scalar>::work(from, (std::min)(delta, to));
        const Scalar bent = line(from) + beam_stiffness(p, L) * L * L * work;
        return delta <= to ? bent : bent + line(delta) - line(to);
    }
    /// A bound ≥ max(T′(l), T(l)/l) over all l > 0, N/m [T3], [T23]: the beam is stiffest at l → 0,
    /// where T′ = 12π²k_b/L³.
    template <class Real>
    static Real stiffness_bound(const Parameters<Real>& p, Real L) {
        using network_detail::where_less;
        const Real linear = where_less(p.stiffness, p.onset, p.onset, p.stiffness);
        const Real touching = Real(3 * Arc<Real>::touching) * beam_stiffness(p, L);
        const Real larger = where_less(linear, touching, touching, linear);
        return where_less(Real(0), onset_excess(p, L), larger, linear);
    }

private:
    template <class Real>
    using Arc = network_detail::Arc<Real>;

    /// 1/L, 1/m; 1 for L = 0, where the line is the law, and for a register's gaps.
    template <class Real>
    static Real inverse(const Real& L) {
        using network_detail::where_less;
        return Real(1) / where_less(Real(0), L, L, Real(1));
    }
    /// λ = l/L, 1 where it is more.
    template <class Real>
    static Real chord(const Real& L, const Real& l) {
        using network_detail::where_less;
        const Real lambda = l * inverse(L);
        return where_less(lambda, Real(1), lambda, Real(1));
    }
    /// T along the beam, N; < 0 where l ≥ L, too.
    template <class Real>
    static Real beam_tension(const Parameters<Real>& p, const Real& L, const Real& l) {
        return Real(-4) * p.bending * inverse(L) * inverse(L) * Arc<Real>::slope(chord(L, l));
    }
    /// T′ along the beam, N/m.
    template <class Real>
    static Real beam_slope(const Parameters<Real>& p, const Real& L, const Real& l) {
        return beam_stiffness(p, L) * Arc<Real>::curvature(chord(L, l));
    }
    /// 4k_b/L³, N/m.
    template <class Real>
    static Real beam_stiffness(const Parameters<Real>& p, const Real& L) {
        return Real(4) * p.bending * inverse(L) * inverse(L) * inverse(L);
    }
    /// > 0 if the beam pushes less than the line anywhere: c = c_b L³/(4k_b) above the least
    /// G(λ)/(1 − λ), which is 7.8678 at λ = 0.28.
    template <class Real>
    static Real onset_excess(const Parameters<Real>& p, const Real& L) {
        using network_detail::where_less;
        constexpr auto least = static_cast<typename Arc<Real>::Scalar>(7.867775);
        return where_less(Real(0), L, p.onset - Real(least) * beam_stiffness(p, L), Real(0));
    }
    /// The least and the largest shortening δ = 1 − l/L at which the beam is the law, where it
    /// shows.
    template <class Scalar>
    static std::pair<Scalar, Scalar> arc_ends(const Parameters<Scalar>& p, Scalar L) {
        const Scalar c = p.onset / beam_stiffness(p, L);
        const Scalar from = crossing(c, 3 / c, Scalar(-1));
        const Scalar to = c < Arc<Scalar>::touching ? crossing(c, Scalar(1), Scalar(1)) : Scalar(1);
        return {from, (std::max)(from, to)};
    }
    /// The δ where line and beam push alike, cδ = G, by Newton from a δ outside of the roots: G is
    /// convex, so the iterates approach the nearer root from one side, or pass where there is none.
    /// @param side  1 from above, −1 from below
    template <class Scalar>
    static Scalar crossing(Scalar c, Scalar delta, Scalar side) {
        for (int i = 0; i < 64; ++i) {
            const Scalar excess = c * delta - Arc<Scalar>::slope(1 - delta);
            const Scalar step = excess / (c - Arc<Scalar>::curvature(1 - delta));
            if (!(step * side > 4 * std::numeric_limits<Scalar>::epsilon() * delta)) break;
            delta = std::clamp(delta - step, Scalar(0), Scalar(1));
        }
        return delta;
    }
};

}  // namespace taut

#if defined(TAUT_COMPILED)
#include "../compiled_laws.hpp"
#endif
