// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "detail/where_less.hpp"
#include "hookean.hpp"

namespace taut {

/// A string: T = k·max(l − L, 0), energy ½k·max(l − L, 0)². It never pushes, so the energy is
/// convex in the positions and the converged implicit step cannot raise it [T24].
///
/// The stretch and shear springs of Choi & Ko, "Stable but responsive cloth", SIGGRAPH 2002.
struct TensionOnly {
    static constexpr bool convex = true;
    static constexpr bool vectorizable = true;

    template <class Scalar>
    using Parameters = Hookean::Parameters<Scalar>;

    /// T(l), N; never negative.
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        using network_detail::where_less;
        return where_less(L, l, p.stiffness * (l - L), Scalar(0));
    }
    /// T′(l), N/m; at l = L that of the slack side.
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        using network_detail::where_less;
        return where_less(L, l, p.stiffness, Scalar(0));
    }
    /// Energy, J.
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return l > L ? Scalar(0.5) * p.stiffness * (l - L) * (l - L) : Scalar(0);
    }
    /// A bound ≥ max(T′(l), T(l)/l) over all l > 0, N/m [T3], [T23].
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar) {
        return p.stiffness;
    }
};

}  // namespace taut

#if defined(TAUT_COMPILED)
#include "../compiled_laws.hpp"
#endif
