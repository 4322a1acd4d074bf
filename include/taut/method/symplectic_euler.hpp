// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>

#include "detail/scalar_mode.hpp"

namespace taut::method {

/// The descriptor of symplectic Euler [T5]; what its members mean: ExplicitEuler.
struct SymplecticEuler {
    static constexpr Method method = Method::symplectic_euler;
    static constexpr const char* name = "symplectic_euler";
    static constexpr int order = 1;
    static constexpr bool is_implicit = false;
    static constexpr bool averages_forces = false;
    using Limit = LimitedByStiffness;
    static constexpr AnyPose any_pose = AnyPose::limited;

    /// [T10].
    static StepQuadratic step_quadratic(double k, double d, double h) {
        const double hd = h * d;
        const double hhk = h * h * k;
        return {hd + hhk - 2, 1 - hd};
    }
    /// The largest |μ| of that polynomial.
    static double spectral_radius(double k, double d, double h) {
        return taut::method_detail::largest_root(step_quadratic(k, d, h));
    }
    /// 4/(d + √(d² + 4k)) [T10].
    static double critical_step(double k, double d) {
        const double root = taut::method_detail::discriminant_root(d, k);
        return root < 0 ? std::numeric_limits<double>::infinity() : 2 / (d / 2 + root / 2);
    }
    /// v⁺ from the old x, then x⁺ from v⁺.
    template <class Matrix>
    static Matrix step_matrix(const Matrix& C, typename Matrix::Scalar h, Eigen::Index positions) {
        const Eigen::Index r = positions;
        const Eigen::Index N = C.rows() - r;
        Matrix step = Matrix::Identity(C.rows(), C.cols());
        step.bottomRows(N) += h * C.bottomRows(N);
        step.topRows(r) += h * C.block(0, r, r, r).diagonal().asDiagonal() * step.middleRows(r, r);
        return step;
    }
    /// ε² + bε + z² = 0 for ε = μ − 1, from μ² − (2 − hd − h²k)μ + (1 − hd) = 0 [T10].
    static std::complex<double> multiplier_less_one(double z, double zeta) {
        const double b = z * (2 * zeta + z);
        const double under = (2 * z - b) * (2 * z + b);
        if (under > 0) return {-b / 2, std::sqrt(under) / 2};
        const double far = -(b + std::sqrt(-under)) / 2;
        return b > 2 ? far : z * z / far;
    }
    /// H + ½h v·f − ¼h vᵀDv, J [T36].
    template <class Books>
    static double kept_energy(const Books& books, double h) {
        return books.total() + h / 2 * books.power - h / 4 * books.braking(h);
    }
    /// ½h of gravity's and the pins' power, J.
    template <class Books>
    static double energy_lag(const Books& books, double h) {
        return h / 2 * (books.fall_power + books.pin_power);
    }
    /// [1 − b − √(b² + s²), 1 + s] with s the share, b braked.
    static EnergyBand energy_band(double share, double braked) {
        return {1 - braked - std::hypot(braked, share), 1 + share};
    }
};

}  // namespace taut::method
