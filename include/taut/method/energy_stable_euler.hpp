// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "symplectic_euler.hpp"

namespace taut::method {

/// The descriptor of the energy-stable Euler step [T42]; what its members mean: ExplicitEuler. In
/// the linear it is symplectic Euler with D + hK⁺, since springs push along their old direction.
/// What is proved of it holds at every pose and speed: no limit is asked for at one.
struct EnergyStableEuler : KeepsNoEnergy {
    static constexpr Method method = Method::energy_stable_euler;
    static constexpr const char* name = "energy_stable_euler";
    static constexpr int order = 1;
    static constexpr bool is_implicit = false;
    static constexpr bool averages_forces = false;
    using Limit = Absent;
    static constexpr AnyPose any_pose = AnyPose::proved;

    static StepQuadratic step_quadratic(double k, double d, double h) {
        return SymplecticEuler::step_quadratic(k, d + h * std::max(0.0, k), h);
    }
    /// The largest |μ| of that polynomial.
    static double spectral_radius(double k, double d, double h) {
        return taut::method_detail::largest_root(step_quadratic(k, d, h));
    }
    /// That of 4 − 2hd − 3h²k⁺ + h²k⁻ = 0 [T10].
    static double critical_step(double k, double d) {
        return SymplecticEuler::critical_step(k > 0 ? 3 * k : k, d);
    }
    /// v⁺ from x + hv where k > 0, from the old x elsewhere; then x⁺ from v⁺.
    template <class Matrix>
    static Matrix step_matrix(Matrix C, typename Matrix::Scalar h, Eigen::Index positions) {
        const Eigen::Index r = positions;
        const auto rise = C.block(0, r, r, r).diagonal();
        const auto fall = C.block(r, 0, r, r).diagonal();
        const auto pull = rise.cwiseProduct(fall).cwiseMin(0).eval();
        C.block(r, r, r, r).diagonal() += h * pull;
        return SymplecticEuler::step_matrix(C, h, positions);
    }
    /// Of symplectic Euler with the damping ratio ζ + z/2.
    static std::complex<double> multiplier_less_one(double z, double zeta) {
        return SymplecticEuler::multiplier_less_one(z, zeta + z / 2);
    }
};

}  // namespace taut::method
