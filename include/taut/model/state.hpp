// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/error.hpp"
#include "../core/types.hpp"

namespace taut {
namespace detail {

/// Index of the first particle with a coordinate that is not finite, or -1.
template <class Array>
Index first_not_finite(const Array& x, const Array& v) {
    for (Index i = 0; i < x.cols(); ++i) {
        if (!x.col(i).allFinite() || !v.col(i).allFinite()) return i;
    }
    return -1;
}

/// Whether a State or StateView has as many positions and velocities.
template <class AnyState>
bool fits(const AnyState& state, Index particles) {
    return state.x.cols() == particles && state.v.cols() == particles;
}
/// Fails with a message that begins with `where` unless the state fits.
/// @param has  what says how many: "the system has"   @param of  what a column is one of
template <class AnyState>
void require_fits(const char* where, const AnyState& state, Index particles,
                  const char* has = "the system has", const char* of = "particles") {
    if (fits(state, particles)) return;
    fail(where, ": the state has ", state.x.cols(), " positions and ", state.v.cols(),
         " velocities; ", has, " ", particles, " ", of);
}

}  // namespace detail

/// Positions and velocities at one time; w = (x, v) of theory [T1].
template <class Scalar_, int Dim_>
struct State {
    using Scalar = Scalar_;
    static constexpr int Dim = Dim_;

    Points<Scalar, Dim> x;  ///< Dim × n, m
    Points<Scalar, Dim> v;  ///< Dim × n, m/s
    Scalar time = 0;        ///< s

    /// Dim × n zeros.
    static Points<Scalar, Dim> zero(Index n) { return Points<Scalar, Dim>::Zero(Dim, n); }
    /// Whether every coordinate is, of x and v.
    bool finite() const {
        // x − x is 0, or NaN where x is not finite; and so is the sum, which takes whole registers.
        return (x - x).sum() == Scalar(0) && (v - v).sum() == Scalar(0);
    }
    /// Index of the first particle with a coordinate that is not finite, or -1.
    Index first_not_finite() const { return detail::first_not_finite(x, v); }
};

}  // namespace taut
