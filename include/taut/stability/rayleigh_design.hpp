// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "../model/damping.hpp"
#include "rayleigh.hpp"

namespace taut {

/// ζ = d0/(2ω) + αω/2, the damping ratio of Rayleigh damping at angular frequency ω, rad/s.
inline double damping_ratio(const RayleighDamping& rayleigh, double omega) {
    if (!(omega > 0) || !std::isfinite(omega)) {
        fail("damping_ratio: omega is ", omega, "; it must be finite and > 0");
    }
    return rayleigh.mass_proportional / (2 * omega) + rayleigh.stiffness_proportional * omega / 2;
}

/// The Rayleigh damping with ratio zeta_1 at omega_1 and zeta_2 at omega_2, rad/s. A factor comes
/// out negative when the ratios lie too far apart for the form d0/(2ω) + αω/2; then the call fails.
inline RayleighDamping rayleigh_from_ratios(double omega_1, double zeta_1, double omega_2,
                                            double zeta_2) {
    if (!(omega_1 > 0) || !(omega_2 > 0) || omega_1 == omega_2 || !std::isfinite(omega_1) ||
        !std::isfinite(omega_2)) {
        fail("rayleigh_from_ratios: the frequencies are ", omega_1, " and ", omega_2,
             "; they must be finite, > 0 and different");
    }
    require_non_negative("rayleigh_from_ratios", "zeta_1", zeta_1);
    require_non_negative("rayleigh_from_ratios", "zeta_2", zeta_2);
    const double difference = omega_2 * omega_2 - omega_1 * omega_1;
    RayleighDamping rayleigh;
    rayleigh.stiffness_proportional = 2 * (zeta_2 * omega_2 - zeta_1 * omega_1) / difference;
    rayleigh.mass_proportional =
        2 * omega_1 * omega_2 * (zeta_1 * omega_2 - zeta_2 * omega_1) / difference;
    if (rayleigh.stiffness_proportional < 0 || rayleigh.mass_proportional < 0) {
        fail("rayleigh_from_ratios: ratios ", zeta_1, " and ", zeta_2, " at ", omega_1, " and ",
             omega_2, " rad/s ask for d0 = ", rayleigh.mass_proportional,
             " and alpha = ", rayleigh.stiffness_proportional, "; both must be >= 0");
    }
    return rayleigh;
}

/// Two choices of α inside the window of a step.
struct RayleighDesign {
    AlphaWindow window;           ///< empty: the two values below mean nothing
    double least_damping = 0;     ///< α, s: the modes keep their energy best
    double fastest_settling = 0;  ///< α, s: the slowest mode dies out soonest
};

/// Chooses α for step h, s, and mass-proportional damping d0, 1/s, where the modes to care for have
/// k in [k_min, k_max], 1/s². The least damping is the lower end of the window and a thousandth of
/// its width; the fastest settling makes the larger of the two end modes' |μ| smallest, which
/// decides for all between [T13].
inline RayleighDesign rayleigh_design(Method method, double h, double d0, double k_min,
                                      double k_max) {
    RayleighDesign design;
    design.window = rayleigh_window(method, h, d0, k_min, k_max);
    const auto& window = design.window;
    if (window.empty != EmptyWindow::none) return design;
    design.least_damping =
        window.includes_zero ? 0 : window.lower + 1e-3 * (window.upper - window.lower);
    const auto radius = [&](double alpha) {
        return std::max(spectral_radius(method, k_min, d0 + alpha * k_min, h),
                        spectral_radius(method, k_max, d0 + alpha * k_max, h));
    };
    // Each |μ| is quasi-convex in α, and so is the larger: golden section finds the minimum. Beyond
    // 2/√k_min even the softest mode is overdamped, which bounds an infinite window.
    double low = window.lower;
    double high = std::isfinite(window.upper) ? window.upper
                  : k_min > 0                 ? 4 / std::sqrt(k_min)
                                              : low;
    const double golden = (std::sqrt(5.0) - 1) / 2;
    for (int repeat = 0; repeat < 80; ++repeat) {
        const double left = high - golden * (high - low);
        const double right = low + golden * (high - low);
        (radius(left) < radius(right) ? high : low) = radius(left) < radius(right) ? right : left;
    }
    design.fastest_settling = (low + high) / 2;
    design.least_damping = std::min(design.least_damping, design.fastest_settling);
    return design;
}

}  // namespace taut
