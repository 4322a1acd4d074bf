// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/types.hpp"

namespace taut {
namespace model_detail {

/// Index of the first particle with a coordinate that is not finite, or -1.
template <class Array>
Index first_not_finite(const Array& x, const Array& v) {
    for (Index i = 0; i < x.cols(); ++i) {
        if (!x.col(i).allFinite() || !v.col(i).allFinite()) return i;
    }
    return -1;
}

}  // namespace model_detail

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
    Index first_not_finite() const { return model_detail::first_not_finite(x, v); }
};

}  // namespace taut
