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
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        if (l >= L) return p.stiffness * (l - L);
        const Scalar line = p.onset * (l - L);
        if (line >= -12 * beam_unit(p, L)) return line;  // no arc pushes less
        return (std::max)(line, -4 * beam_unit(p, L) / arc(L, l).lever);
    }
    /// T′(l), N/m; at the kinks that of one side.
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        if (l >= L) return p.stiffness;
        const Scalar line = p.onset * (l - L);
        if (line >= -12 * beam_unit(p, L)) return p.onset;
        const auto bent = arc(L, l);
        if (line >= -4 * beam_unit(p, L) / bent.lever) return p.onset;
        return arc_slope(p, L, bent);
    }
    /// The least and the largest T′ between two lengths, N/m, on both sides of each kink.
    template <class Scalar>
    static std::pair<Scalar, Scalar> slope_range(const Parameters<Scalar>& p, Scalar L, Scalar low,
                                                 Scalar high) {
        auto range = network_detail::slopes_at_ends_and_rest<Buckling>(p, L, low, high);
        if (!beam_shows(p, L)) return range;
        // Along the arc T′ falls as l grows, so that its ends and those of the interval decide.
        const auto [from, to] = arc_ends(p, L);
        for (const Scalar w : {from, to}) {
            const auto bent = network_detail::Arc<Scalar>::at(w);
            const Scalar l = L * (1 - w * bent.sag);
            if (l >= low && l <= high) network_detail::widen(range, {arc_slope(p, L, bent)});
        }
        return range;
    }
    /// Energy, J: 2k_b w/L + constant along the beam, w = (κL/2)², and that of the line beside it.
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        if (l >= L) return Scalar(0.5) * p.stiffness * (l - L) * (l - L);
        const auto line = [&](Scalar shortening) {  // δ = 1 − l/L
            return Scalar(0.5) * p.onset * L * L * shortening * shortening;
        };
        const Scalar delta = (L - l) / L;
        if (!beam_shows(p, L)) return line(delta);
        const auto [from, to] = arc_ends(p, L);
        const Scalar w = arc(L, l).w;
        if (w <= from) return line(delta);
        const auto shortening = [](Scalar at) {
            return at * network_detail::Arc<Scalar>::at(at).sag;
        };
        const Scalar bent =
            line(shortening(from)) + 2 * beam_unit(p, L) * L * ((std::min)(w, to) - from);
        return w <= to ? bent : bent + line(delta) - line(shortening(to));
    }
    /// A bound ≥ max(T′(l), T(l)/l) over all l > 0, N/m [T3], [T23]: the beam is stiffest at l → 0,
    /// where T′ = 12π²k_b/L³.
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar L) {
        const Scalar linear = (std::max)(p.stiffness, p.onset);
        if (!beam_shows(p, L)) return linear;
        return (std::max)(linear,
                          12 * network_detail::Arc<Scalar>::touching * (beam_unit(p, L) / L));
    }

private:
    /// k_b/L², N; infinite for L = 0, where the line is the law.
    template <class Scalar>
    static Scalar beam_unit(const Parameters<Scalar>& p, Scalar L) {
        return p.bending / L / L;
    }
    /// Whether the beam pushes less than the line anywhere: c = c_b L³/(4k_b) above the least
    /// 1/(w·A·B), which is 7.8678 at w = 5.782.
    template <class Scalar>
    static bool beam_shows(const Parameters<Scalar>& p, Scalar L) {
        return L > 0 && p.onset > Scalar(31.4711) * (beam_unit(p, L) / L);
    }
    template <class Scalar>
    static network_detail::Arc<Scalar> arc(Scalar L, Scalar l) {
        return network_detail::Arc<Scalar>::shortened((L - l) / L);
    }
    /// T′ along the beam, N/m.
    template <class Scalar>
    static Scalar arc_slope(const Parameters<Scalar>& p, Scalar L,
                            const network_detail::Arc<Scalar>& bent) {
        const Scalar cube = bent.lever * bent.lever * bent.lever;
        return -8 * (beam_unit(p, L) / L) * bent.lever_w / cube;
    }
    /// The least and the largest w at which the beam is the law, where it shows.
    template <class Scalar>
    static std::pair<Scalar, Scalar> arc_ends(const Parameters<Scalar>& p, Scalar L) {
        constexpr Scalar touching = network_detail::Arc<Scalar>::touching;
        const Scalar c = p.onset / (4 * beam_unit(p, L) / L);
        return {crossing(c, 18 / c), c < touching ? crossing(c, touching) : touching};
    }
    /// The w where line and beam push alike, c·w·A·B = 1, by Newton from a w outside of the roots:
    /// w·A·B is concave, so the iterates approach the nearer root from one side.
    template <class Scalar>
    static Scalar crossing(Scalar c, Scalar w) {
        for (int i = 0; i < 64; ++i) {
            const auto at = network_detail::Arc<Scalar>::at(w);
            const Scalar excess = w * at.sag * at.lever - 1 / c;
            const Scalar slope = Scalar(0.5) * at.lever * at.lever + w * at.sag * at.lever_w;
            const Scalar step = excess / slope;
            if (!((std::abs)(step) > 4 * std::numeric_limits<Scalar>::epsilon() * w)) break;
            w = std::clamp(w - step, Scalar(0), network_detail::Arc<Scalar>::touching);
        }
        return w;
    }
};

}  // namespace taut

#if defined(TAUT_COMPILED)
#include "../compiled_laws.hpp"
#endif
