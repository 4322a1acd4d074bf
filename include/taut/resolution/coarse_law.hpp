// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <type_traits>

#include "../network/buckling.hpp"
#include "../network/hookean.hpp"

namespace taut {

/// How coarsen() makes one spring of many of a law: each adds its strengths (forces, N, which hold
/// whatever the length that the strain is of), and their sum has the law's parameters at another
/// length. Specialise it for a law of your own. This one serves every law whose parameters are
/// those of Hookean: the strength is k·l.
template <class Law>
struct CoarseLaw {
    /// Whether it serves the law.
    static constexpr bool known =
        std::is_same_v<typename Law::template Parameters<double>, Hookean::Parameters<double>>;

    /// @param L  m, rest length   @param l  m, length in the pose   @returns forces, N
    static std::array<double, 1> strengths(const Hookean::Parameters<double>& p,
                                           [[maybe_unused]] double L, double l) {
        return {p.stiffness * l};
    }
    /// @param sum  N, of the strengths   @param L, l  m, as above, of the coarse spring
    static Hookean::Parameters<double> parameters(const std::array<double, 1>& sum,
                                                  [[maybe_unused]] double L, double l) {
        return {sum[0] / l};
    }
};

/// A beam pushes by k_b/L² times a function of its strain.
template <>
struct CoarseLaw<Buckling> {
    static constexpr bool known = true;

    /// @returns the forces of both lines at a strain of 1, and k_b/L², N
    static std::array<double, 3> strengths(const Buckling::Parameters<double>& p, double L,
                                           double l) {
        return {p.stiffness * l, L > 0 ? p.bending / L / L : 0, p.onset * l};
    }
    /// @returns those of a spring with such strengths
    static Buckling::Parameters<double> parameters(const std::array<double, 3>& sum, double L,
                                                   double l) {
        return {sum[0] / l, sum[1] * L * L, sum[2] / l};
    }
};

}  // namespace taut
