// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../conditions/mode.hpp"
#include "effort.hpp"
#include "symplectic_limit.hpp"

// What refutes steps of symplectic Euler and velocity Verlet: a vector.

namespace taut::proof_detail {

/// The step that u refutes for symplectic Euler: the root of uᵀ(4M − 2hD − h²K)u. For an indefinite
/// K too: a real multiplier ≤ −1 follows from the vector alone.
inline double refuted_by(const Pencil& pencil, const Eigen::VectorXd& u) {
    const auto [k, d] = quotients(pencil, u, K);
    return critical_step(Method::symplectic_euler, k.lower(), (std::max)(0.0, d.lower()));
}

/// [T19]'s iteration: the leading vector of 2hD + h²K refutes a smaller step than h, and so on
/// until a repeat gains less than `settled` of it.
template <class Real = double>
void sharpen_symplectic(const Pencil& pencil, const LanczosOptions& options, double settled,
                        double& h, Eigen::VectorXd& vector) {
    constexpr int most_repeats = 8;
    // Without dampers the vector does not depend on h.
    const bool once = pencil.is_rayleigh() && pencil.stiffness_semidefinite();
    for (int repeat = 0; repeat < (once ? 1 : most_repeats); ++repeat) {
        RitzPair next = largest_ritz_pair(pencil, 2 * h * D + h * h * K, options, vector);
        const double smaller = refuted_by(pencil, next.vector);
        if (!(smaller < h)) return;
        vector = std::move(next.vector);
        const bool last = smaller > h * (1 - settled);
        h = smaller;
        if (last) return;
    }
}

/// A step that a vector refutes, from the stiffest vector of K⁺, which the refuting one replaces.
template <class Real = double>
double refuted_symplectic(const Pencil& pencil, Eigen::VectorXd& vector) {
    double h = refuted_by(pencil, vector);
    if (pencil.is_rayleigh() && pencil.stiffness_semidefinite()) return h;
    // The stiffest vector of K⁺ may lie where the true K is buckled: begin elsewhere.
    for (const Combination& c : {K, D}) {
        if (detail::is_finite(h)) break;
        RitzPair other = largest_ritz_pair(pencil, c);
        h = refuted_by(pencil, other.vector);
        if (detail::is_finite(h)) vector = std::move(other.vector);
    }
    if (detail::is_finite(h)) sharpen_symplectic(pencil, {}, 1e-4, h, vector);
    return h;
}

/// Which term of 2hD + h²K is the larger on the refuting vector u. Their sum is 4M there, so
/// damping is when 2hD has more than half of it.
inline Cause symplectic_cause(const Pencil& pencil, double h, const Eigen::VectorXd& u) {
    const double m = pencil.quadratic(M, u).value;
    return h * pencil.quadratic(D, u).value > m ? Cause::damping : Cause::stiffness;
}

/// The bracket of the largest stable step.
/// @param start   start(h): N, near the vector on which 2hD + h²K⁺ is largest, to begin a search
template <class Effort, class Start>
UnroundedLimit symplectic_bracket(const Pencil& pencil, Effort& effort, Start&& start) {
    const UnroundedLimit limit = symplectic_by_bounds(pencil);
    if (!(limit.certified > 0) || !detail::is_finite(limit.certified)) return limit;
    Bracket bracket;
    bracket.certified = limit.certified;
    bracket.vector = start(bracket.certified);
    bracket.refuted = refuted_symplectic(pencil, bracket.vector);
    effort.narrow_symplectic(pencil, bracket);
    return {bracket.certified, bracket.refuted,
            symplectic_cause(pencil, bracket.certified, bracket.vector)};
}

template <class Scalar, class Effort>
StepLimit<Scalar> bracket_of_laplacians(const Pencil& laplacian, Effort& effort,
                                        std::uint64_t revision, double part = 1) {
    UnroundedLimit limit{0, infinity, Cause::overflow};
    if (laplacian.lost().empty()) {
        limit = symplectic_bracket(laplacian, effort, [&](double h) {
            return leading_pair(laplacian, 2 * h * D + h * h * K_plus).vector;
        });
    }
    limit.certified *= part;
    limit.refuted *= part;
    return rounded<Scalar>(limit, revision);
}

}  // namespace taut::proof_detail
