// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "detail/limit_of.hpp"
#include "detail/scales.hpp"
#include "stability.hpp"

namespace taut {

template <class Scalar>
StepLimit<Scalar> Stability<Scalar>::max_step(Method method) const {
    return proof_detail::limit_of<Scalar>(method, *pencil_, revision_,
                                          proof_detail::ByBounds{*pencil_});
}

template <class Scalar>
AlphaWindow Stability<Scalar>::rayleigh_window(Method method, double h, double d0) const {
    if (size() == 0) return taut::rayleigh_window(method, h, d0, 0, 0, 0);
    const double stiffest = pencil_->upper_bound(matrices::K_plus);
    const bool by_damping = method::is_limited_by<method::LimitedByDamping>(method);
    const double compression = by_damping ? pencil_->compression() : 0;
    if (!detail::is_finite(stiffest) || !detail::is_finite(compression)) {
        return {0, 0, EmptyWindow::overflow, false};
    }
    return taut::rayleigh_window(method, h, d0, 0, (std::max)(0.0, stiffest), compression);
}

template <class Scalar>
double Stability<Scalar>::max_stiffness_scale(Method method, double h) const {
    require_positive("Stability::max_stiffness_scale", "h", h);
    return proof_detail::max_stiffness_scale(method, *pencil_, h);
}

template <class Scalar>
double Stability<Scalar>::min_mass_scale(Method method, double h) const {
    require_positive("Stability::min_mass_scale", "h", h);
    return proof_detail::min_mass_scale(method, *pencil_, h);
}

}  // namespace taut
