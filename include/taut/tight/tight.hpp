// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../conditions/mode.hpp"
#include "../proof/bracket.hpp"
#include "certificate.hpp"
#include "dense.hpp"
#include "detail/factorisations.hpp"
#include "detail/zero_modes.hpp"
#include "explicit_estimate.hpp"

// Limits as tight as wanted, by sparse factorisations, and eigenvalues by dense solvers: with the
// second, Stability answers the eigenvalue problem of a step under any damping.

namespace taut {

/// The bracket of Stability::max_step, narrowed by sparse factorisations until refuted/certified ≤
/// 1 + tightness (and 10 ulp of Scalar) where the method's conditions allow it (1e-6 is reachable;
/// a factorisation or two) [T22], up to DenseAnalysis<>::good_size degrees of freedom also by dense
/// eigensolvers. Under dampers explicit Euler gets an `estimate` beside it [T18].
/// @param tightness  ≥ 0 and finite; 0: by bounds alone
template <class Scalar>
StepLimit<Scalar> max_step(const Stability<Scalar>& stability, Method method, double tightness) {
    require_non_negative("max_step", "tightness", tightness);
    if (tightness == 0) return bracket(stability, method);
    proof_detail::Factorisations<> effort(tightness);
    return proof_detail::bracket(stability, method, effort);
}

/// any_pose_limit(system), narrowed by factorisations of n × n matrices until refuted/certified ≤
/// 1 + tightness [T22]. @param tightness  ≥ 0 and finite; 0: by bounds alone
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> any_pose_limit(const SpringSystem<Scalar, Dim, Laws...>& system,
                                 double tightness) {
    require_non_negative("any_pose_limit", "tightness", tightness);
    if (tightness == 0) return any_pose_bracket(system);
    proof_detail::Factorisations<> effort(tightness);
    return proof_detail::bracket_of_laplacians<Scalar>(Pencil::any_pose(system), effort,
                                                       system.revision());
}

/// energy_limit(system), narrowed as any_pose_limit's bracket is [T22].
/// @param tightness  ≥ 0 and finite; 0: by bounds alone
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> energy_limit(const SpringSystem<Scalar, Dim, Laws...>& system, double tightness) {
    require_non_negative("energy_limit", "tightness", tightness);
    if (tightness == 0) return energy_bracket(system);
    proof_detail::Factorisations<> effort(tightness);
    return proof_detail::bracket_of_laplacians<Scalar>(
        Pencil::any_pose(system, Pencil::Damping::half), effort, system.revision(), 0.5);
}

/// Answer of certify().
struct Certificate {
    Method method = Method::symplectic_euler;
    double step = 0;      ///< h, s
    bool proved = false;  ///< false means not proved, which is not a disproof
};

/// Whether step h, s, is proved stable: by the bound, or else by factorisation [T22].
template <class Scalar>
Certificate certify(const Stability<Scalar>& stability, Method method, double h) {
    Certificate certificate{method, h, false};
    require_positive("certify", "h", h);
    certificate.proved = h <= static_cast<double>(stability.max_step(method).certified);
    if (certificate.proved) return certificate;
    const StepLimit<Scalar> bound = bracket(stability, method);
    if (!(h < static_cast<double>(bound.refuted))) return certificate;
    const Pencil& pencil = stability.pencil();
    const double wide = h * (1 + proof_detail::step_rounding<Scalar>);
    // An h² that underflows would leave the stiffness out.
    if (method::is_limited_by<method::LimitedByStiffness>(method) &&
        h * h >= (std::numeric_limits<double>::min)() && pencil.damping_semidefinite() &&
        pencil.projected_semidefinite()) {
        Prover prover;
        certificate.proved = proof_detail::proves_symplectic(pencil, prover, wide);
        return certificate;
    }
    // A bracket narrowed to its distance from h may still contain h: the refuting end moves too.
    double distance = (std::min)(1.0, static_cast<double>(bound.refuted) / h - 1);
    for (int repeat = 0; repeat < 8 && !certificate.proved; ++repeat) {
        const StepLimit<Scalar> narrowed = max_step(stability, method, (std::max)(distance, 1e-9));
        certificate.proved = h <= static_cast<double>(narrowed.certified);
        if (!(h < static_cast<double>(narrowed.refuted)) || distance < 1e-9) break;
        distance = (std::min)(distance / 8, static_cast<double>(narrowed.refuted) / h - 1);
    }
    return certificate;
}

/// Rigid motions and mechanisms: the eigenvalues of K'⁺ below 1e-10·k_max, by the inertia of
/// K⁺ − εM, one sparse factorisation. Numerical, without an error bound.
template <class Scalar>
Index count_zero_modes(const Stability<Scalar>& stability) {
    if (stability.size() == 0) return 0;
    return proof_detail::count_zero_modes(stability.pencil(),
                                          stiffness_spectrum(stability).k_max.upper);
}

/// Largest |μ| of one step of size h, s, apart from zero modes; of BDF2 too. Exact to rounding up
/// to DenseAnalysis<>::good_size degrees of freedom; above, an estimate from below by the extreme
/// Ritz values (D taken as Rayleigh, or by its quotients on those two vectors).
template <class Scalar>
double spectral_radius(const Stability<Scalar>& stability, Method method, double h) {
    require_positive("spectral_radius", "h", h);
    const Pencil& pencil = stability.pencil();
    if (pencil.size() == 0) return 0;
    if (pencil.size() <= DenseAnalysis<>::good_size) {
        return DenseAnalysis<>(pencil).spectral_radius(method, h);
    }
    // For fixed h the radius is quasi-convex in k (for BDF2 known only without damping), so the
    // ends of the spectrum decide.
    double radius = 0;
    for (const double sign : {1.0, -1.0}) {
        const RitzPair end = largest_ritz_pair(pencil, sign * matrices::K_plus);
        const auto [k, d] = proof_detail::quotients(pencil, end.vector, matrices::K_plus);
        if ((std::abs)(k.value) <= k.error && (std::abs)(d.value) <= d.error)
            continue;  // a zero mode
        radius = (std::max)(radius, spectral_radius(method, k.value, d.value, h));
    }
    return radius;
}

}  // namespace taut
