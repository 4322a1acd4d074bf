// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../method/mode.hpp"
#include "effort.hpp"

// Symplectic Euler, and velocity Verlet with it: 4M − 2hD − h²K ≻ 0.

namespace taut::stability_detail {

/// The largest step of which 4M − 2hD − h²K⁺ ≻ 0 is proved by the bound [T19], [T23].
/// @param enough  a bound on k_max, 1/s², that need not be improved
inline double certified_symplectic(const Pencil& pencil, double enough = 0) {
    if (pencil.is_rayleigh()) {
        const double k = std::max(0.0, pencil.upper_bound(K_plus, enough));
        const auto& rayleigh = pencil.rayleigh();
        if (!std::isfinite(k)) return 0;  // overflow: nothing is proved
        return critical_step(Method::symplectic_euler, k,
                             rayleigh.mass_proportional + rayleigh.stiffness_proportional * k);
    }
    // g(h) bounds M⁻¹(2hD + h²K⁺)/4 and is convex with g(0) = 0: from h the step h/√g is safe as
    // well, and larger, until g = 1.
    const auto g = [&](double h) { return pencil.upper_bound(2 * h * D + h * h * K_plus) / 4; };
    const double k = std::max(0.0, pencil.upper_bound(K_plus));
    const double d = std::max(0.0, pencil.upper_bound(D));
    if (!std::isfinite(k) || !std::isfinite(d)) return 0;
    double h = critical_step(Method::symplectic_euler, k, d);
    for (int repeat = 0; repeat < 8 && std::isfinite(h); ++repeat) {
        const double larger = h / std::sqrt(g(h));
        if (!(larger > h * (1 + 1e-4))) break;
        h = larger;
    }
    return h;
}

/// The step that u refutes for symplectic Euler: the root of uᵀ(4M − 2hD − h²K)u. For an indefinite
/// K too: a real multiplier ≤ −1 follows from the vector alone.
inline double refuted_by(const Pencil& pencil, const Eigen::VectorXd& u) {
    const auto [k, d] = quotients(pencil, u, K);
    return critical_step(Method::symplectic_euler, k.lower(), std::max(0.0, d.lower()));
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
        if (std::isfinite(h)) break;
        RitzPair other = largest_ritz_pair(pencil, c);
        h = refuted_by(pencil, other.vector);
        if (std::isfinite(h)) vector = std::move(other.vector);
    }
    if (std::isfinite(h)) sharpen_symplectic(pencil, {}, 1e-4, h, vector);
    return h;
}

/// Which term of 2hD + h²K is the larger on the refuting vector u. Their sum is 4M there, so
/// damping is when 2hD has more than half of it.
inline Cause symplectic_cause(const Pencil& pencil, double h, const Eigen::VectorXd& u) {
    const double m = pencil.quadratic(M, u).value;
    return h * pencil.quadratic(D, u).value > m ? Cause::damping : Cause::stiffness;
}

/// The bracket of the largest stable step.
/// @param enough  a bound on k_max, 1/s², that need not be improved
/// @param start   start(h): N, near the vector on which 2hD + h²K⁺ is largest, to begin a search
template <class Start>
UnroundedLimit symplectic_limit(const Pencil& pencil, Effort& effort, double enough,
                                Start&& start) {
    Bracket bracket;
    bracket.certified = pencil.size() == 0 ? infinity : certified_symplectic(pencil, enough);
    if (!std::isfinite(bracket.certified)) return {infinity, infinity, Cause::nothing_to_limit};
    if (!(bracket.certified > 0)) return {0, infinity, Cause::overflow};
    bracket.vector = start(bracket.certified);
    bracket.refuted = refuted_symplectic(pencil, bracket.vector);
    effort.narrow_symplectic(pencil, bracket);
    return {bracket.certified, bracket.refuted,
            symplectic_cause(pencil, bracket.certified, bracket.vector)};
}

}  // namespace taut::stability_detail
