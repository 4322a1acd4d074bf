// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../core/detail/bisection.hpp"

namespace taut {
namespace detail {

/// The `count` largest shares, in descending order.
template <class Share>
std::vector<Share> largest_shares(std::vector<Share> shares, Index count) {
    const auto kept = std::clamp<Index>(count, 0, static_cast<Index>(shares.size()));
    std::partial_sort(shares.begin(), shares.begin() + kept, shares.end(),
                      [](const Share& a, const Share& b) { return a.share > b.share; });
    shares.resize(static_cast<std::size_t>(kept));
    return shares;
}

/// How well the scales of max_stiffness_scale and min_mass_scale are found, relative.
inline constexpr double scale_tolerance = 1e-9;

// The step that the bound certifies by what limits the method, s.
inline double certified_by(method::LimitedByDamping, const Pencil& pencil) {
    const double k = std::max(0.0, pencil.upper_bound({0, 1, 0}));
    const double d = std::max(0.0, pencil.upper_bound({0, 0, 1}));
    return k > 0 || d > 0 ? certified_explicit(pencil, k, d) : infinity;
}
inline double certified_by(method::LimitedByStiffness, const Pencil& pencil) {
    return certified_symplectic(pencil);
}
inline double certified_by(method::LimitedByIndefiniteness, const Pencil& pencil) {
    const double kappa = std::max(0.0, pencil.upper_bound({0, -1, 0}));
    return kappa == 0 || pencil.stiffness_semidefinite() ? infinity : 1 / std::sqrt(kappa);
}

}  // namespace detail

template <class Scalar, class Cholesky>
std::vector<SpringShare> Stability<Scalar, Cholesky>::limiting_springs(Index count) const {
    if (size() == 0) return {};
    return detail::largest_shares(pencil_->spring_shares(limiting_mode().shape), count);
}

template <class Scalar, class Cholesky>
std::vector<ParticleShare> Stability<Scalar, Cholesky>::limiting_particles(Index count) const {
    if (size() == 0) return {};
    return detail::largest_shares(pencil_->particle_shares(limiting_mode().shape), count);
}

/// The step that the bound certifies after scaling, s.
template <class Scalar, class Cholesky>
double Stability<Scalar, Cholesky>::certified_when_scaled(Method method, double stiffness,
                                                          double mass) const {
    return method::visit_limited("Stability", method, [&](auto descriptor) {
        using Limit = typename decltype(descriptor)::Limit;
        return detail::certified_by(Limit{}, *pencil_->scaled(stiffness, mass));
    });
}

template <class Scalar, class Cholesky>
double Stability<Scalar, Cholesky>::max_stiffness_scale(Method method, double h) const {
    require_positive("Stability::max_stiffness_scale", "h", h);
    if (size() == 0) return detail::infinity;
    if (!pencil_->damping_semidefinite()) return 0;
    const auto holds = [&](double scale) { return certified_when_scaled(method, scale, 1) >= h; };
    return detail::last_that_passes(1.0, detail::scale_tolerance, holds);
}

template <class Scalar, class Cholesky>
double Stability<Scalar, Cholesky>::min_mass_scale(Method method, double h) const {
    require_positive("Stability::min_mass_scale", "h", h);
    if (size() == 0) return 0;
    if (!pencil_->damping_semidefinite()) return detail::infinity;
    // As far as double holds the masses, and d0·M, as normal numbers.
    const Eigen::VectorXd& mass = pencil_->mass();
    const double d0 = pencil_->rayleigh().mass_proportional;
    const double least = std::numeric_limits<double>::min() / mass.minCoeff();
    const double most =
        std::numeric_limits<double>::max() / 8 / mass.maxCoeff() / std::max(1.0, d0);
    const auto holds = [&](double lighter) {
        const double scale = std::clamp(1 / lighter, std::min(least, 1.0), std::max(most, 1.0));
        return certified_when_scaled(method, 1, scale) >= h;
    };
    return 1 / detail::last_that_passes(1.0, detail::scale_tolerance, holds);
}

template <class Scalar, class Cholesky>
std::optional<Index> Stability<Scalar, Cholesky>::substeps(Method method, double frame) const {
    require_positive("Stability::substeps", "frame", frame);
    const double certified = static_cast<double>(max_step(method).certified);
    // Beyond 1e15 the count is no longer exact, and no frame was meant.
    if (!(certified > 0) || !(frame / certified < 1e15)) return std::nullopt;
    return std::max<Index>(1, static_cast<Index>(std::ceil(frame / certified)));
}

}  // namespace taut
