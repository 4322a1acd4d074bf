// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../core/detail/bisection.hpp"
#include "limit_of.hpp"

// What would make a step safe, by the bound alone.

namespace taut::proof_detail {

/// How well the two scales below are found, relative.
inline constexpr double scale_tolerance = 1e-9;

/// The step that the bound certifies after scaling, s.
inline double certified_when_scaled(Method method, const Pencil& pencil, double stiffness,
                                    double mass) {
    const Pencil scaled = pencil.scaled(stiffness, mass);
    if (method::is_limited_by<method::LimitedByIndefiniteness>(method)) {  // of bare matrices, too
        const double kappa = (std::max)(0.0, scaled.upper_bound(-K_plus));
        return kappa == 0 || scaled.stiffness_semidefinite() ? infinity : 1 / std::sqrt(kappa);
    }
    return method::visit_limited("Stability", method, [&](auto descriptor) {
        return ByBounds{scaled}(typename decltype(descriptor)::Limit{}).certified;
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
