// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "symplectic_euler.hpp"

namespace taut::method {

/// The descriptor of GraphInertia with every spring implicit [T33]: symplectic Euler of the mass
/// a = 1 + (hd/2 + (1 + δ)h²k/4)/θ and the damping d + δhk/(2θ), for d of dampers and Rayleigh's α.
/// A stepper whose springs are implicit in part errs less.
struct GraphInertia : SymplecticEuler {
    static constexpr Method method = Method::graph_inertia;
    static constexpr const char* name = "graph_inertia";
    static constexpr int order = 1;
    using Limit = LimitedByDrag;
    static constexpr AnyPose any_pose = AnyPose::every_step;
    /// θ, what GraphInertiaOptions has unless told otherwise.
    static constexpr double margin = 0.83;
    /// δ, likewise.
    static constexpr double dissipation = 0.01;

    /// Symplectic Euler's, of the heavier mode.
    static StepQuadratic step_quadratic(double k, double d, double h) {
        const double a = mass(k, d, h);
        return SymplecticEuler::step_quadratic(k / a, (d + braking(k, h)) / a, h);
    }
    /// The largest |μ| of that polynomial.
    static double spectral_radius(double k, double d, double h) {
        return taut::method_detail::largest_root(step_quadratic(k, d, h));
    }
    /// Infinity: 4a − 2h(d + δhk/(2θ)) − h²k > 0 for every h.
    static double critical_step(double, double) { return std::numeric_limits<double>::infinity(); }
    /// Symplectic Euler's, with A in place of M and D + D_i in place of D; both are of K⁺.
    template <class Matrix>
    static Matrix step_matrix(const Matrix& C, typename Matrix::Scalar h, Eigen::Index positions) {
        using Real = typename Matrix::Scalar;
        const Eigen::Index r = positions;
        const Eigen::Index N = C.rows() - r;
        // M⁻¹K in the coordinates of the velocities, the first r of which move positions.
        Matrix K = Matrix::Zero(N, N);
        K.leftCols(r) = -C.bottomLeftCorner(N, r) * C.block(0, r, r, r).diagonal().asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Matrix> modes((K + K.transpose()) / 2);
        const Matrix& U = modes.eigenvectors();
        const Matrix projected =
            U * modes.eigenvalues().cwiseMax(Real(0)).asDiagonal() * U.transpose();
        const Matrix D = -C.bottomRightCorner(N, N);
        constexpr Real theta = margin, delta = dissipation;
        const Matrix heavier =
            Matrix::Identity(N, N) + (h / 2 * D + (1 + delta) * h * h / 4 * projected) / theta;
        Matrix slower = C;
        slower.bottomRightCorner(N, N) -= delta * h / 2 / theta * projected;
        slower.bottomRows(N) = heavier.partialPivLu().solve(slower.bottomRows(N)).eval();
        return SymplecticEuler::step_matrix(slower, h, positions);
    }
    /// As symplectic Euler's, of the heavier mode.
    static std::complex<double> multiplier_less_one(double z, double zeta) {
        const double root = std::sqrt(mass(1, 2 * zeta, z));
        return SymplecticEuler::multiplier_less_one(z / root, (zeta + braking(1, z) / 2) / root);
    }

private:
    static double mass(double k, double d, double h) {
        return 1 + (h * d / 2 + (1 + dissipation) * h * h * std::max(k, 0.0) / 4) / margin;
    }
    static double braking(double k, double h) {
        return dissipation * h * std::max(k, 0.0) / 2 / margin;
    }
};

}  // namespace taut::method
