// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

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

inline constexpr double smallest_scale = 1e-12;
inline constexpr double largest_scale = 1e12;

/// The point, within 1e-9 relative, up to which `holds` is true for scales that grow from `from`
/// towards `to`; `from` itself must hold.
template <class Holds>
double last_scale(double from, double to, Holds&& holds) {
    while (std::abs(std::log(to / from)) > 1e-9) {
        const double middle = std::sqrt(from * to);
        (holds(middle) ? from : to) = middle;
    }
    return from;
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
    const auto pencil = pencil_->scaled(stiffness, mass);
    const double k = std::max(0.0, pencil->upper_bound({0, 1, 0}));
    switch (method) {
        case Method::explicit_euler: {
            const double d = std::max(0.0, pencil->upper_bound({0, 0, 1}));
            return k > 0 || d > 0 ? detail::certified_explicit(*pencil, k, d) : detail::infinity;
        }
        case Method::symplectic_euler:
        case Method::velocity_verlet: return detail::certified_symplectic(*pencil);
        case Method::implicit_euler: {
            const double kappa = std::max(0.0, pencil->upper_bound({0, -1, 0}));
            return kappa == 0 || pencil->stiffness_semidefinite() ? detail::infinity
                                                                  : 1 / std::sqrt(kappa);
        }
    }
    return 0;
}

template <class Scalar, class Cholesky>
double Stability<Scalar, Cholesky>::max_stiffness_scale(Method method, double h) const {
    require_positive("Stability::max_stiffness_scale", "h", h);
    if (size() == 0) return detail::infinity;
    if (!pencil_->damping_semidefinite()) return 0;
    const auto holds = [&](double scale) { return certified_when_scaled(method, scale, 1) >= h; };
    if (holds(detail::largest_scale)) return detail::infinity;
    if (!holds(detail::smallest_scale)) return 0;
    return detail::last_scale(detail::smallest_scale, detail::largest_scale, holds);
}

template <class Scalar, class Cholesky>
double Stability<Scalar, Cholesky>::min_mass_scale(Method method, double h) const {
    require_positive("Stability::min_mass_scale", "h", h);
    if (size() == 0) return 0;
    if (!pencil_->damping_semidefinite()) return detail::infinity;
    const auto holds = [&](double scale) { return certified_when_scaled(method, 1, scale) >= h; };
    if (holds(detail::smallest_scale)) return 0;
    if (!holds(detail::largest_scale)) return detail::infinity;
    return detail::last_scale(detail::largest_scale, detail::smallest_scale, holds);
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
