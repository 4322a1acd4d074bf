// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "../../conditions/mode.hpp"
#include "../../conditions/visit.hpp"
#include "symplectic_limit.hpp"

namespace taut::proof_detail {

TAUT_INLINE SymplecticStep certified_symplectic(const Pencil& pencil) {
    if (pencil.is_rayleigh()) {
        const double k = (std::max)(0.0, pencil.upper_bound(K_plus));
        const auto& rayleigh = pencil.rayleigh();
        if (!detail::is_finite(k)) return {0, k};  // overflow: nothing is proved
        const double d = rayleigh.mass_proportional + rayleigh.stiffness_proportional * k;
        return {critical_step(Method::symplectic_euler, k, d), k};
    }
    // g(h) bounds M⁻¹(2hD + h²K⁺)/4 and is convex with g(0) = 0: from h the step h/√g is safe as
    // well, and larger, until g = 1.
    const auto g = [&](double h) { return pencil.upper_bound(2 * h * D + h * h * K_plus) / 4; };
    const double k = (std::max)(0.0, pencil.upper_bound(K_plus));
    const double d = (std::max)(0.0, pencil.upper_bound(D));
    if (!detail::is_finite(k) || !detail::is_finite(d)) return {0, k};
    double h = critical_step(Method::symplectic_euler, k, d);
    for (int repeat = 0; repeat < 8 && detail::is_finite(h); ++repeat) {
        const double larger = h / std::sqrt(g(h));
        if (!(larger > h * (1 + 1e-4))) break;
        h = larger;
    }
    return {h, k};
}

TAUT_INLINE UnroundedLimit symplectic_by_bounds(const Pencil& pencil) {
    const auto [h, k] =
        pencil.size() == 0 ? SymplecticStep{infinity, 0} : certified_symplectic(pencil);
    if (!detail::is_finite(h)) return {infinity, infinity, Cause::nothing_to_limit};
    if (!(h > 0)) return {0, infinity, Cause::overflow};
    // Of 4 = 2hd + h²k at the limit damping has more than half where stiffness cannot have it.
    return {h, infinity, h * h * k < 2 ? Cause::damping : Cause::stiffness};
}

TAUT_INLINE void add_compression(const Pencil& pencil, UnroundedLimit& limit) {
    if (pencil.stiffness_semidefinite() || !claims(limit)) return;
    limit.admitted_growth = std::sqrt(pencil.deficit(K));
}

TAUT_INLINE UnroundedLimit by_laplacian(const Pencil& laplacian, double part) {
    UnroundedLimit limit{0, infinity, Cause::overflow};
    if (laplacian.lost().empty()) limit = symplectic_by_bounds(laplacian);
    limit.certified *= part;
    return limit;
}

TAUT_INLINE Pencil::Damping counted_at_any_pose(Method method) {
    const bool proved = method::any_pose(method) == method::AnyPose::proved;
    return proved ? Pencil::Damping::half : Pencil::Damping::all;
}

TAUT_INLINE UnroundedLimit at_any_pose(Method method, const Pencil& laplacian) {
    using method::AnyPose;
    const AnyPose proof = method::any_pose(method);
    const bool proved = proof == AnyPose::proved;
    const UnroundedLimit limit = by_laplacian(laplacian, proved ? 0.5 : 1);
    if (proved || proof == AnyPose::limited) return limit;
    if (!(limit.certified > 0) || !detail::is_finite(limit.certified)) return limit;
    if (proof == AnyPose::every_step) {
        method::visit_limited("any_pose_limit", method, [](auto) { return true; });  // not BDF2
        return {infinity, infinity, Cause::unconditional};
    }
    const bool damped = laplacian.upper_bound(D) > 0;
    return {0, infinity, damped ? Cause::one_pose_only : Cause::undamped};
}

}  // namespace taut::proof_detail
