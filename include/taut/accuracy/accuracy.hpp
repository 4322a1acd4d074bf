// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "../core/detail/bisection.hpp"
#include "../core/error.hpp"
#include "../conditions/visit.hpp"
#include "detail/multiplier.hpp"

// How well each integrator follows one mode ẍ + 2ζω ẋ + ω² x = 0, from its exact multiplier [T25].
// z = hω is the step in radians of the undamped mode.

namespace taut {

/// What a step does to a mode that it should leave as it is.
struct ModeError {
    double artificial_damping = 0;  ///< damping ratio of the steps less ζ; negative: they feed it
    double period_error = 0;        ///< period of the steps over the true one, less 1
};

namespace tradeoff_detail {

inline void require_mode(const char* function, double z, double zeta) {
    require_positive(function, "z", z);
    if (!(zeta >= 0) || !(zeta < 1) || !detail::is_finite(zeta)) {
        fail(function, ": zeta is ", zeta, "; it must be >= 0 and < 1, or there is no period");
    }
}

}  // namespace tradeoff_detail

/// The exact errors of one mode: ln μ/h against λ. For ζ = 0 and small z the damping ratio is
/// −z/2 (explicit Euler), 0, 0, z/2 (implicit Euler), z³/4 (BDF2) and z/2 (energy-stable Euler),
/// the period error z²/3, −z²/24, −z²/24, z²/3, z²/3 and −z²/6 [T25]. With ζ > 0 all
/// but BDF2, of order 2, err like z.
/// @param z  hω, rad, > 0   @param zeta  the mode's own damping ratio, in [0, 1)
inline ModeError mode_error(Method method, double z, double zeta = 0) {
    tradeoff_detail::require_mode("mode_error", z, zeta);
    const auto e = method::visit(
        method, [&](auto descriptor) { return method::multiplier_less_one(descriptor, z, zeta); });
    const double decay = -std::log1p(2 * e.real() + std::norm(e)) / 2;
    const double phase = std::atan2(e.imag(), 1 + e.real());
    return {decay / std::hypot(decay, phase) - zeta,
            std::sqrt((1 - zeta) * (1 + zeta)) * z / phase - 1};
}

/// The first of mode_error's two errors.
inline double artificial_damping(Method method, double z, double zeta = 0) {
    return mode_error(method, z, zeta).artificial_damping;
}
/// The second.
inline double period_error(Method method, double z, double zeta = 0) {
    return mode_error(method, z, zeta).period_error;
}

/// How much error is tolerable; infinity where one of the two does not matter.
struct ModeTolerance {
    double damping_ratio = 0.05;  ///< on |artificial damping ratio|
    double period = 0.05;         ///< on |period error|

    /// Whether both errors are within it.
    bool admits(const ModeError& error) const {
        return (std::abs)(error.artificial_damping) <= damping_ratio &&
               (std::abs)(error.period_error) <= period;
    }
};

/// The largest h, s, up to which every step keeps a mode of that frequency within tolerance, solved
/// on the exact multiplier; modes below it with the same damping ratio err less. Infinity when
/// every step does. Safe is another question: usable h = min(safe h, accurate h) [T25].
/// @param up_to_frequency  ω, rad/s, > 0   @param zeta  the mode's own damping ratio, in [0, 1)
inline double accurate_step(Method method, const ModeTolerance& tolerance, double up_to_frequency,
                            double zeta = 0) {
    require_positive("accurate_step", "up_to_frequency", up_to_frequency);
    for (const double bound : {tolerance.damping_ratio, tolerance.period}) {
        if (!(bound > 0)) fail("accurate_step: a tolerance is ", bound, "; both must be > 0");
    }
    // Errors of a damped mode may change sign, so the first step that errs too much is sought from
    // below. All errors are below z at small z.
    constexpr double stride = 1.02;
    constexpr double everything = 1e6;  // radians a step
    double low = 1e-2 * (std::min)({0.1, tolerance.damping_ratio, tolerance.period});
    while (tolerance.admits(mode_error(method, low * stride, zeta))) {
        low *= stride;
        if (low > everything) return std::numeric_limits<double>::infinity();
    }
    detail::Bisection<double> search(low, low * stride, 0);
    while (search.open())
        search.narrow(tolerance.admits(mode_error(method, search.middle(), zeta)));
    return search.passes() / up_to_frequency;
}

}  // namespace taut
