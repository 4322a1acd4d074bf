// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/detail/finite.hpp"
#include "../core/types.hpp"

namespace taut {
namespace network_detail {

/// Index of the first particle with a coordinate that is not finite, or -1.
template <class Array>
Index first_not_finite(const Array& x, const Array& v) {
    for (Index i = 0; i < x.cols(); ++i) {
        for (Index d = 0; d < x.rows(); ++d) {
            if (!detail::is_finite(x(d, i)) || !detail::is_finite(v(d, i))) return i;
        }
    }
    return -1;
}

}  // namespace network_detail

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
    bool finite() const { return detail::all_finite(x) && detail::all_finite(v); }
    /// Index of the first particle with a coordinate that is not finite, or -1.
    Index first_not_finite() const { return network_detail::first_not_finite(x, v); }
};

}  // namespace taut
