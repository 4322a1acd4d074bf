// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <complex>

#include "../core/method.hpp"
#include "mode.hpp"
#include "pencil.hpp"

namespace taut {

/// Full eigenvalue computations for small systems: O(N³), good to rounding, numerical (no proof).
/// K⁺ is used throughout; modes of K whose eigenvalue is zero to rounding are zero modes and are
/// left out of limits and radii.
class DenseAnalysis {
public:
    explicit DenseAnalysis(const Pencil& pencil);

    /// Eigenvalues of K'⁺, ascending, 1/s².
    const Eigen::VectorXd& stiffness_eigenvalues() const { return modes_.eigenvalues(); }
    /// Eigenvectors in the coordinates u: column j has uᵀMu = 1.
    Eigen::VectorXd mode(Index j) const { return modes_.eigenvectors().col(j).cwiseQuotient(root_); }
    /// Eigenvalues with |k| ≤ this are zero modes.
    double zero_tolerance() const { return zero_; }
    Index zero_modes() const { return (modes_.eigenvalues().array().abs() <= zero_).count(); }

    /// min over λ(C) of −2 Re λ/|λ|², the exact limit of explicit Euler for any D [T18]; 0 when an
    /// undamped mode allows none, infinity when there is nothing but zero modes.
    double explicit_limit() const;
    /// Largest |μ| of one step over all modes but the zero modes.
    double spectral_radius(Method method, double h) const;

private:
    Eigen::MatrixXd generator() const;

    Eigen::VectorXd root_;  // √M
    Eigen::MatrixXd D_;     // M^-½ D M^-½
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes_;
    double zero_ = 0;
};

inline DenseAnalysis::DenseAnalysis(const Pencil& pencil) : root_(pencil.mass().cwiseSqrt()) {
    const auto scaled = [&](const Combination& c) {
        const Eigen::VectorXd inverse = root_.cwiseInverse();
        const Eigen::MatrixXd S = Eigen::MatrixXd(pencil.assemble(c));
        return Eigen::MatrixXd(inverse.asDiagonal() * S * inverse.asDiagonal());
    };
    D_ = scaled({0, 0, 1});
    modes_.compute(scaled({0, 1, 0}));
    const double norm = modes_.eigenvalues().cwiseAbs().maxCoeff();
    zero_ = 64 * static_cast<double>(pencil.size()) * std::numeric_limits<double>::epsilon() * norm;
}

/// C [T1] without the positions of zero modes, which no force depends on: [[0, Rᵀ], [−KR, −D]] with
/// R the other modes. What is left of λ = 0 is simple, and so is computed to full accuracy.
inline Eigen::MatrixXd DenseAnalysis::generator() const {
    const Index N = root_.size();
    const Index zeros = zero_modes();
    const Index r = N - zeros;
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(r + N, r + N);
    // In modal coordinates K is diagonal; a permutation brings the zero modes last.
    Eigen::MatrixXd V(N, N);
    Eigen::VectorXd k(N);
    Index front = 0;
    Index back = r;
    for (Index j = 0; j < N; ++j) {
        const Index to = std::abs(modes_.eigenvalues()[j]) <= zero_ ? back++ : front++;
        V.col(to) = modes_.eigenvectors().col(j);
        k[to] = modes_.eigenvalues()[j];
    }
    C.topRightCorner(r, r).setIdentity();
    C.block(r, 0, r, r).diagonal() = -k.head(r);
    C.bottomRightCorner(N, N) = -V.transpose() * D_ * V;
    return C;
}

inline double DenseAnalysis::explicit_limit() const {
    const Eigen::MatrixXd C = generator();
    const Eigen::VectorXcd lambda = C.eigenvalues();
    const double norm = C.cwiseAbs().maxCoeff();
    double limit = std::numeric_limits<double>::infinity();
    for (const auto& value : lambda) {
        const double rounding =
            64 * static_cast<double>(C.rows()) * std::numeric_limits<double>::epsilon();
        // λ = 0 to rounding: a zero mode's velocity. Its scale is √‖K‖, not ‖C‖.
        if (std::abs(value) <= rounding * std::max(std::sqrt(norm), norm)) continue;
        if (value.real() >= -rounding * std::abs(value)) return 0;
        limit = std::min(limit, -2 * value.real() / std::norm(value));
    }
    return limit;
}

inline double DenseAnalysis::spectral_radius(Method method, double h) const {
    const Eigen::MatrixXd C = generator();
    const Index n = C.rows();
    const Index N = root_.size();
    const Index r = n - N;
    const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd step;
    switch (method) {
        case Method::explicit_euler: step = I + h * C; break;
        case Method::symplectic_euler:
        case Method::velocity_verlet: {
            // v⁺ from the old x, then x⁺ from v⁺.
            step = I;
            step.bottomRows(N) += h * C.bottomRows(N);
            step.topRows(r) += h * step.block(r, 0, r, n);
            break;
        }
        case Method::implicit_euler: step = (I - h * C).partialPivLu().inverse(); break;
    }
    double radius = 0;
    for (const auto& mu : Eigen::VectorXcd(step.eigenvalues())) {
        // The velocity of an undamped zero mode: multiplier exactly 1.
        if (std::abs(mu - 1.0) <= 64 * static_cast<double>(n) * std::numeric_limits<double>::epsilon()) {
            continue;
        }
        radius = std::max(radius, std::abs(mu));
    }
    return radius;
}

}  // namespace taut
