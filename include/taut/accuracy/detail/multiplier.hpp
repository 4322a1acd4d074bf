// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <complex>

#include "../../conditions/visit.hpp"

// multiplier_less_one(descriptor, z, zeta): μ − 1 of the multiplier μ that stands for e^(hλ),
// λ = ω(−ζ + i√(1 − ζ²)), without cancellation at small z = hω [T25]. Where a step too large has
// turned the pair real, the root of larger modulus.

namespace taut::method {

/// hλ.
inline std::complex<double> exponent(double z, double zeta) {
    return {-zeta * z, std::sqrt((1 - zeta) * (1 + zeta)) * z};
}

inline std::complex<double> multiplier_less_one(ExplicitEuler, double z, double zeta) {
    return exponent(z, zeta);
}
/// ε² + bε + z² = 0 for ε = μ − 1, from μ² − (2 − hd − h²k)μ + (1 − hd) = 0 [T10]. Velocity
/// Verlet's too.
inline std::complex<double> multiplier_less_one(const SymplecticEuler&, double z, double zeta) {
    const double b = z * (2 * zeta + z);
    const double under = (2 * z - b) * (2 * z + b);
    if (under > 0) return {-b / 2, std::sqrt(under) / 2};
    const double farther = -(b + std::sqrt(-under)) / 2;
    return b > 2 ? farther : z * z / farther;
}
/// Of symplectic Euler with the damping ratio ζ + z/2.
inline std::complex<double> multiplier_less_one(EnergyStableEuler, double z, double zeta) {
    return multiplier_less_one(SymplecticEuler{}, z, zeta + z / 2);
}
/// w/(1 − w), w = hλ.
inline std::complex<double> multiplier_less_one(ImplicitEuler, double z, double zeta) {
    const std::complex<double> w = exponent(z, zeta);
    return w / (1.0 - w);
}
/// (3 − 2w)μ² − 4μ + 1 = 0 for w = hλ, so μ = (2 + s)/(3 − 2w) with s = √(1 + 2w).
inline std::complex<double> multiplier_less_one(Bdf2, double z, double zeta) {
    const std::complex<double> w = exponent(z, zeta);
    const std::complex<double> s = std::sqrt(1.0 + 2.0 * w);
    return 2.0 * w * (2.0 + s) / ((1.0 + s) * (3.0 - 2.0 * w));
}

}  // namespace taut::method
