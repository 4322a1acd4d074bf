// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../dense.hpp"
#include "../lanczos.hpp"
#include "../mode.hpp"
#include "../step_limit.hpp"

// One function a method: the bracket of its largest stable step, for any pencil, in double. Those
// that search for vectors are templates, so that only their callers compile the eigensolver.

namespace taut::detail {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// What one vector says of a system: enclosures of uᵀKu/uᵀMu and uᵀDu/uᵀMu.
struct Quotients {
    Enclosed k;
    Enclosed d;
};

inline Quotients quotients(const Pencil& pencil, const Eigen::VectorXd& u, bool project) {
    const Enclosed m = pencil.quadratic({1, 0, 0}, u);
    const auto over_m = [&](const Enclosed& q) {
        const double value = q.value / m.value;
        return Enclosed{value, (q.error + std::abs(value) * m.error) / m.lower()};
    };
    return {over_m(pencil.quadratic({0, 1, 0, project}, u)),
            over_m(pencil.quadratic({0, 0, 1}, u))};
}

/// The smallest eigenvalue of K'⁺ from above. The softest modes are smooth, so the search begins
/// with the translation along an axis that costs least (none at all on a mechanism).
template <class Real = double>
RitzPair softest(const Pencil& pencil) {
    LanczosOptions options;
    options.basis = 48;
    Eigen::VectorXd start;
    double least = infinity;
    for (Index axis = 0; axis < pencil.dim(); ++axis) {
        Eigen::VectorXd u = Eigen::VectorXd::Zero(pencil.size());
        for (Index i = axis; i < u.size(); i += pencil.dim()) u[i] = 1;
        const double k = quotients(pencil, u, true).k.value;
        if (k < least) {
            least = k;
            start = std::move(u);
        }
    }
    return largest_ritz_pair(pencil, {0, -1, 0}, options, start);
}

/// The largest step of which 4M − 2hD − h²K⁺ ≻ 0 is proved by the bound [T19], [T23].
/// @param enough  a bound on k_max, 1/s², that need not be improved
inline double certified_symplectic(const Pencil& pencil, double enough = 0) {
    if (pencil.is_rayleigh()) {
        const double k = std::max(0.0, pencil.upper_bound({0, 1, 0}, enough));
        const auto& rayleigh = pencil.rayleigh();
        if (!std::isfinite(k)) return 0;  // overflow: nothing is proved
        return critical_step(Method::symplectic_euler, k,
                             rayleigh.mass_proportional + rayleigh.stiffness_proportional * k);
    }
    // g(h) bounds M⁻¹(2hD + h²K⁺)/4 and is convex with g(0) = 0: from h the step h/√g is safe as
    // well, and larger, until g = 1.
    const auto g = [&](double h) { return pencil.upper_bound({0, h * h, 2 * h}) / 4; };
    const double k = std::max(0.0, pencil.upper_bound({0, 1, 0}));
    const double d = std::max(0.0, pencil.upper_bound({0, 0, 1}));
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
    const auto [k, d] = quotients(pencil, u, false);
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
        RitzPair next = largest_ritz_pair(pencil, {0, h * h, 2 * h, false}, options, vector);
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
    for (const Combination& c : {Combination{0, 1, 0, false}, Combination{0, 0, 1}}) {
        if (std::isfinite(h)) break;
        RitzPair other = largest_ritz_pair(pencil, c);
        h = refuted_by(pencil, other.vector);
        if (std::isfinite(h)) vector = std::move(other.vector);
    }
    if (std::isfinite(h)) sharpen_symplectic(pencil, {}, 1e-4, h, vector);
    return h;
}

/// Which term of 2hD + h²K the refuting vector u feels most; half of 4M is D's when hd = 1.
inline Cause symplectic_cause(const Pencil& pencil, double h, const Eigen::VectorXd& u) {
    const double m = pencil.quadratic({1, 0, 0}, u).value;
    return h * pencil.quadratic({0, 0, 1}, u).value > m ? Cause::damping : Cause::stiffness;
}

/// Whether the two sufficient conditions of explicit Euler hold at h by the bound [T17]:
/// D − hK⁺ ≻ 0 and 4M − 2hD + h²K ≻ 0. The second one needs the true K, since K ⪯ K⁺.
inline bool certifies_explicit(const Pencil& pencil, double h) {
    const double strict = h * (1 + 1e-9);
    return pencil.upper_bound({0, strict, -1}) <= 0 &&
           pencil.upper_bound({0, -h * h, 2 * h, false}) < 4;
}

/// The largest step that proved bounds k on k_max and d on the largest eigenvalue of D' certify for
/// explicit Euler, or else the bound at each step tried; 0: none.
inline double certified_explicit(const Pencil& pencil, double k, double d) {
    if (!std::isfinite(k)) return 0;
    const auto [d0, alpha] = pencil.rayleigh();
    if (pencil.is_rayleigh() && pencil.stiffness_semidefinite()) {
        // k may be anything in (0, k_max]: as k → 0 the limit is 2/d0, or α when d0 = 0 [T9],
        // [T13].
        const double at_zero = d0 > 0 ? 2 / d0 : alpha;
        return k > 0 ? std::min(at_zero, critical_step(Method::explicit_euler, k, d0 + alpha * k))
                     : critical_step(Method::explicit_euler, 0, d0);
    }
    // The stable steps are an interval (0, h_max) [T18]: bisect on a logarithmic scale, downwards
    // from the limit that K alone sets for any commuting damping [T12].
    double high = k > 0 ? 2 / std::sqrt(k) : 4 / d;
    double low = high * 1e-12;
    if (!certifies_explicit(pencil, low)) return 0;
    while (certifies_explicit(pencil, high)) high *= 2;
    while (high > low * (1 + 1e-4)) {
        const double middle = std::sqrt(low * high);
        (certifies_explicit(pencil, middle) ? low : high) = middle;
    }
    return low;
}

/// uᵀ(4M − 2hD + h²K)u ≤ 0 proves a multiplier ≤ −1 of explicit Euler, for any symmetric D and K.
inline double refuted_by_damping(const Pencil& pencil, const Eigen::VectorXd& u) {
    const auto [k_enclosed, d_enclosed] = quotients(pencil, u, false);
    const double k = k_enclosed.upper();
    const double d = std::max(0.0, d_enclosed.lower());
    return d > 0 && d * d >= 4 * k ? 4 / (d + std::sqrt(d * d - 4 * k)) : infinity;
}

/// @param commutes  whether M, D and the stepper's K share their eigenvectors
template <class Real = double>
double refuted_explicit(const Pencil& pencil, const RitzPair& stiffest, bool commutes) {
    const RitzPair most_damped = largest_ritz_pair(pencil, {0, 0, 1});
    double h = std::min(refuted_by_damping(pencil, stiffest.vector),
                        refuted_by_damping(pencil, most_damped.vector));
    if (!commutes) return h;
    // Every Rayleigh quotient of K' lies in [k_min, k_max], and where [T8] fails at one of these it
    // fails at an end of the spectrum [T13].
    const RayleighDamping rayleigh = pencil.rayleigh();
    const auto limit_at = [&](double k) {
        return critical_step(Method::explicit_euler, k,
                             rayleigh.mass_proportional + rayleigh.stiffness_proportional * k);
    };
    const auto refuted_by = [&](const RitzPair& mode) {
        const Enclosed k = quotients(pencil, mode.vector, false).k;
        return std::max(limit_at(k.lower()), limit_at(k.upper()));
    };
    h = std::min(h, refuted_by(stiffest));
    if (rayleigh.mass_proportional > 0) {
        h = std::min(h, refuted_by(largest_ritz_pair(pencil, {0, -1, 0, false})));
    }
    return h;
}

}  // namespace taut::detail
