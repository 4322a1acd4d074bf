// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/error.hpp"

namespace taut {

/// The linear spring: tension T = k(l − L), energy ½k(l − L)².
///
/// Every law has this form (docs/concepts.md). Its functions take the parameters of one spring, its
/// rest length L and its present length l > 0, in m, and are accurate to a few ulp: of the
/// bound for slopes, N/m, and of the bound times the larger of L and l for T, N.
struct Hookean {
    /// Whether the energy is convex in the positions, as theory [T24] asks.
    static constexpr bool convex = false;
    /// Whether the tension never falls as the length grows; optional, false unless said. A convex
    /// law's never does [T42].
    static constexpr bool monotone = true;
    /// Whether the functions are plain arithmetic, so that Scalar may be a register of numbers.
    static constexpr bool vectorizable = true;

    /// What one spring needs beside its rest length.
    template <class Scalar>
    struct Parameters {
        Scalar stiffness;  ///< k, N/m, ≥ 0

        /// Fails with a message that begins with `where` unless the parameters are in range.
        void require_valid(const char* where) const {
            require_non_negative(where, "stiffness", stiffness);
        }
        /// The parameters in another precision.
        template <class Other>
        Parameters<Other> cast() const {
            return {static_cast<Other>(stiffness)};
        }
    };

    /// T(l), N; positive pulls the ends together.
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return p.stiffness * (l - L);
    }
    /// T′(l), N/m.
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar, Scalar) {
        return p.stiffness;
    }
    /// Energy, J; its derivative by l is the tension.
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return Scalar(0.5) * p.stiffness * (l - L) * (l - L);
    }
    /// A bound ≥ max(T′(l), T(l)/l) over all l > 0, N/m [T3], [T23].
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar) {
        return p.stiffness;
    }
};

}  // namespace taut
