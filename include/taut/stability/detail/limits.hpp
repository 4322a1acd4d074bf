// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../core/detail/bisection.hpp"
#include "../../method/mode.hpp"
#include "../dense.hpp"
#include "../lanczos.hpp"
#include "../step_limit.hpp"

// One function for each limit: the bracket of its largest stable step, for any pencil, in double.
// Those that search for vectors are templates, so that only their callers compile the eigensolver.

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

/// The limit of explicit Euler on one mode [T9], from below and from above.
struct ModeLimit {
    double lower = 0;
    double upper = infinity;
};

/// @param k, d  1/s², 1/s, each as computed. Near critical damping, d² = 4k, the limit moves by the
///              root of what their rounding moves d² − 4k by: 1e-8.
inline ModeLimit explicit_mode_limit(double k, double d) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const double softer = k - rounding * std::abs(k);
    const double stiffer = k + rounding * std::abs(k);
    const double less = d - rounding * std::abs(d);
    const double more = d + rounding * std::abs(d);
    const auto overdamped = [](double k_mode, double d_mode) {
        return d_mode >= 2 * std::sqrt(std::max(k_mode, 0.0));
    };
    // It rises with k and falls with d on one side of critical damping, the other way round on the
    // other, so that corners decide; in between it is largest where d² = 4k, 4/d.
    const double one = critical_step(Method::explicit_euler, stiffer, less);
    const double other = critical_step(Method::explicit_euler, softer, more);
    const bool across = overdamped(stiffer, less) != overdamped(softer, more);
    return {std::min(one, other), across ? 4 / less : std::max(one, other)};
}

/// The largest limit of explicit Euler that a mode with k in [low, high], 1/s², can have. The modes
/// that are stable at one step are an interval of k (section 4), so the limit has one peak: at
/// critical damping, √k = d0/(1 + √(1 − αd0)), as far as d0 > 0.
inline double largest_explicit_limit(const RayleighDamping& rayleigh, double low, double high) {
    const auto [d0, alpha] = rayleigh;
    if (d0 == 0 && low <= 0 && high >= 0) return infinity;  // it may be a zero mode
    double largest = std::max(explicit_mode_limit(low, d0 + alpha * low).upper,
                              explicit_mode_limit(high, d0 + alpha * high).upper);
    if (d0 > 0 && alpha * d0 < 1) {
        const double root = d0 / (1 + std::sqrt(1 - alpha * d0));
        if (root * root > low && root * root < high) {
            // 1 − αd0 rounds as well.
            const double from = 1 - alpha * d0 + 4 * std::numeric_limits<double>::epsilon();
            largest = std::max(largest, 2 * (1 + std::sqrt(from)) / d0);
        }
    }
    return largest;
}

/// The largest step that proved bounds k on k_max and d on the largest eigenvalue of D' certify for
/// explicit Euler, or else the bound at each step tried; 0: none.
inline double certified_explicit(const Pencil& pencil, double k, double d) {
    if (!std::isfinite(k)) return 0;
    const auto [d0, alpha] = pencil.rayleigh();
    if (pencil.is_rayleigh() && pencil.stiffness_semidefinite()) {
        // k may be anything in (0, k_max]: as k → 0 the limit is 2/d0, or α when d0 = 0 [T9],
        // [T13]. Where rounding leaves springs slightly compressed, by κ: 4 − 2hd0 − h²κ ≥ 0 [T17].
        if (!(k > 0)) return critical_step(Method::explicit_euler, 0, d0);
        const double compression =
            pencil.projects() ? std::max(0.0, pencil.upper_bound({0, -1, 0, false})) : 0;
        const double at_zero = critical_step(Method::symplectic_euler, compression, d0);
        return std::min(
            {at_zero, d0 > 0 ? infinity : alpha, explicit_mode_limit(k, d0 + alpha * k).lower});
    }
    // The stable steps are an interval (0, h_max) [T18]. Where damping is weak it ends near the
    // limit that K alone sets for any commuting damping [T12].
    const auto certifies = [&](double h) { return certifies_explicit(pencil, h); };
    if (!certifies(std::numeric_limits<double>::min())) return 0;
    return last_that_passes(k > 0 ? 2 / std::sqrt(k) : 4 / d, 1e-4, certifies);
}

/// uᵀ(4M − 2hD + h²K)u ≤ 0 proves a multiplier ≤ −1 of explicit Euler, for any symmetric D and K.
inline double refuted_by_damping(const Pencil& pencil, const Eigen::VectorXd& u) {
    const auto [k_enclosed, d_enclosed] = quotients(pencil, u, false);
    const double k = k_enclosed.upper();
    const double d = std::max(0.0, d_enclosed.lower());
    const double root = discriminant_root(d, -k);
    return d > 0 && root >= 0 ? 2 / (d / 2 + root / 2) : infinity;
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
    const auto refuted_by = [&](const RitzPair& mode) {
        const Enclosed k = quotients(pencil, mode.vector, false).k;
        return largest_explicit_limit(pencil.rayleigh(), k.lower(), k.upper());
    };
    h = std::min(h, refuted_by(stiffest));
    if (pencil.rayleigh().mass_proportional > 0) {
        h = std::min(h, refuted_by(largest_ritz_pair(pencil, {0, -1, 0, false})));
    }
    return h;
}

}  // namespace taut::detail
