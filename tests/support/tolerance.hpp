// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace taut_test {

/// What "equal" means, relative to the largest quantity involved.
template <class Scalar>
struct Tolerance {
    static constexpr double epsilon = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    /// Sums of some ten terms.
    static constexpr double rounding = 64 * epsilon;
    /// Hundreds of steps, or a linear solve of a well-conditioned matrix.
    static constexpr double accumulated = 8192 * epsilon;
    /// Central differences in double with steps of 1e-5 m.
    static constexpr double difference = 1e-6;
};

/// A scalar and a dimension as one type, for TEMPLATE_TEST_CASE.
template <class Scalar_, int Dim_>
struct Case {
    using Scalar = Scalar_;
    static constexpr int Dim = Dim_;
};

/// max |a − b| in double.
template <class A, class B>
double distance(const A& a, const B& b) {
    return a.size() == 0
               ? 0
               : (a.template cast<double>() - b.template cast<double>()).cwiseAbs().maxCoeff();
}

/// max |a| in double.
template <class A>
double largest(const A& a) {
    return a.size() == 0 ? 0 : a.template cast<double>().cwiseAbs().maxCoeff();
}

}  // namespace taut_test
