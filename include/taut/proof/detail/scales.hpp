// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../core/detail/bisection.hpp"
#include "../../conditions/visit.hpp"
#include "explicit_limit.hpp"
#include "symplectic_limit.hpp"

// What would make a step safe, by the bound alone.

namespace taut::proof_detail {

/// The step that the bound certifies by what limits the method, s.
inline double certified_by(method::LimitedByDamping, const Pencil& pencil) {
    const double k = (std::max)(0.0, pencil.upper_bound(K_plus));
    const double d = (std::max)(0.0, pencil.upper_bound(D));
    return k > 0 || d > 0 ? certified_explicit(pencil, k, d) : infinity;
}

inline double certified_by(method::LimitedByStiffness, const Pencil& pencil) {
    return certified_symplectic(pencil).h;
}

inline double certified_by(method::LimitedByIndefiniteness, const Pencil& pencil) {
    const double kappa = (std::max)(0.0, pencil.upper_bound(-K_plus));
    return kappa == 0 || pencil.stiffness_semidefinite() ? infinity : 1 / std::sqrt(kappa);
}

/// How well the two scales below are found, relative.
inline constexpr double scale_tolerance = 1e-9;

/// The step that the bound certifies after scaling, s.
inline double certified_when_scaled(Method method, const Pencil& pencil, double stiffness,
                                    double mass) {
    return method::visit_limited("Stability", method, [&](auto descriptor) {
        using Limit = typename decltype(descriptor)::Limit;
        return certified_by(Limit{}, pencil.scaled(stiffness, mass));
    });
}

/// The largest factor on all stiffness that leaves step h, s, certified.
inline double max_stiffness_scale(Method method, const Pencil& pencil, double h) {
    if (pencil.size() == 0) return infinity;
    if (!pencil.damping_semidefinite()) return 0;
    return detail::last_that_passes(1.0, scale_tolerance, [&](double scale) {
        return certified_when_scaled(method, pencil, scale, 1) >= h;
    });
}

/// The least factor on all masses that makes step h, s, certified.
inline double min_mass_scale(Method method, const Pencil& pencil, double h) {
    if (pencil.size() == 0) return 0;
    if (!pencil.damping_semidefinite()) return infinity;
    // As far as double holds the masses, and d0·M, as normal numbers.
    const Eigen::VectorXd& mass = pencil.mass();
    const double d0 = pencil.rayleigh().mass_proportional;
    const double least = (std::numeric_limits<double>::min)() / mass.minCoeff();
    const double most = (std::numeric_limits<double>::max)() / 8 /
                        (std::max)(1.0, mass.maxCoeff()) / (std::max)(1.0, d0);
    const double lightest = detail::last_that_passes(1.0, scale_tolerance, [&](double lighter) {
        const double scale = std::clamp(1 / lighter, (std::min)(least, 1.0), (std::max)(most, 1.0));
        return certified_when_scaled(method, pencil, 1, scale) >= h;
    });
    return lightest > 0 ? 1 / lightest : infinity;
}

}  // namespace taut::proof_detail
