// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "implicit_euler.hpp"

namespace taut::method {

/// The descriptor of BDF2 at equal steps [T29]; what its members mean: ExplicitEuler. Each root λ
/// of a mode has the two multipliers 1/(2 ± √(1 + 2hλ)), of modulus ≤ 1 for Re λ ≤ 0, so there are
/// four to a mode and no quadratic. Beside compressed springs nothing is proved of it.
struct Bdf2 : KeepsNoEnergy {
    static constexpr Method method = Method::bdf2;
    static constexpr const char* name = "bdf2";
    static constexpr int order = 2;
    static constexpr bool is_implicit = true;
    static constexpr bool averages_forces = false;
    using Limit = Absent;
    static constexpr AnyPose any_pose = AnyPose::every_step;

    static constexpr Absent step_quadratic{};
    /// The largest 1/|2 − √(1 + 2hλ)|.
    static double spectral_radius(double k, double d, double h) {
        double radius = 0;
        for (const auto& lambda : taut::method_detail::roots({d, k}))
            radius = std::max(radius, 1 / std::abs(2.0 - std::sqrt(1.0 + 2 * h * lambda)));
        return radius;
    }
    /// Infinity; for k < 0 where 1 + τd + τ²k = 0, τ = ⅔h.
    static double critical_step(double k, double d) {
        return 1.5 * ImplicitEuler::critical_step(k, d);
    }
    /// [[4S, −S], [I, 0]] with S = (3 − 2hC)⁻¹, on the state and the one before it: 2n × 2n.
    template <class Matrix>
    static Matrix step_matrix(const Matrix& C, typename Matrix::Scalar h, Eigen::Index) {
        using Real = typename Matrix::Scalar;
        const Eigen::Index n = C.rows();
        const Matrix I = Matrix::Identity(n, n);
        const Matrix solved = (3 * I - 2 * h * C).partialPivLu().inverse();
        Matrix step = Matrix::Zero(2 * n, 2 * n);
        step.topLeftCorner(n, n) = Real(4) * solved;
        step.topRightCorner(n, n) = -solved;
        step.bottomLeftCorner(n, n) = I;
        return step;
    }
    /// (3 − 2w)μ² − 4μ + 1 = 0 for w = hλ, so μ = (2 + s)/(3 − 2w) with s = √(1 + 2w).
    static std::complex<double> multiplier_less_one(double z, double zeta) {
        const std::complex<double> w = taut::method_detail::exponent(z, zeta);
        const std::complex<double> s = std::sqrt(1.0 + 2.0 * w);
        return 2.0 * w * (2.0 + s) / ((1.0 + s) * (3.0 - 2.0 * w));
    }
};

}  // namespace taut::method
