// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "symplectic_euler.hpp"

namespace taut::method {

/// The descriptor of GraphInertia with every spring implicit [T33]: symplectic Euler of the heavier
/// mass m̃ = m + (hd/2 + h²k/4)/θ, where d is that of dampers and Rayleigh's α. A stepper whose
/// springs are implicit in part errs less.
struct GraphInertia : SymplecticEuler {
    static constexpr Method method = Method::graph_inertia;
    static constexpr const char* name = "graph_inertia";
    static constexpr int order = 1;
    using Limit = LimitedByDrag;
    static constexpr AnyPose any_pose = AnyPose::every_step;
    /// θ, what GraphInertiaOptions has unless told otherwise.
    static constexpr double margin = 0.83;

    /// Symplectic Euler's, of k/m̃ and d/m̃.
    static StepQuadratic step_quadratic(double k, double d, double h) {
        const double m = mass(k, d, h);
        return SymplecticEuler::step_quadratic(k / m, d / m, h);
    }
    /// The largest |μ| of that polynomial.
    static double spectral_radius(double k, double d, double h) {
        return taut::method_detail::largest_root(step_quadratic(k, d, h));
    }
    /// Infinity: 4m̃ − 2hd − h²k > 0 for every h.
    static double critical_step(double, double) { return std::numeric_limits<double>::infinity(); }
    /// Symplectic Euler's, with M̃ in place of M; the inertia is that of K⁺.
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
        const Matrix heavier = Matrix::Identity(N, N) +
                               (h / 2 * D + h * h / 4 * projected) / static_cast<Real>(margin);
        Matrix slower = C;
        slower.bottomRows(N) = heavier.partialPivLu().solve(C.bottomRows(N));
        return SymplecticEuler::step_matrix(slower, h, positions);
    }
    /// As symplectic Euler's, of the heavier mode.
    static std::complex<double> multiplier_less_one(double z, double zeta) {
        const double root = std::sqrt(mass(1, 2 * zeta, z));
        return SymplecticEuler::multiplier_less_one(z / root, zeta / root);
    }

private:
    static double mass(double k, double d, double h) {
        return 1 + (h * d / 2 + h * h * std::max(k, 0.0) / 4) / margin;
    }
};

}  // namespace taut::method
