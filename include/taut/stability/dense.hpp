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
    /// @param project  take K⁺ for K
    explicit DenseAnalysis(const Pencil& pencil, bool project = true);

    /// Eigenvalues of K'⁺, ascending, 1/s².
    const Eigen::VectorXd& stiffness_eigenvalues() const { return modes_.eigenvalues(); }
    /// Eigenvectors in the coordinates u: column j has uᵀMu = 1.
    Eigen::VectorXd mode(Index j) const {
        return modes_.eigenvectors().col(j).cwiseQuotient(root_);
    }
    /// Eigenvalues with |k| ≤ this are zero modes.
    double zero_tolerance() const { return zero_; }
    Index zero_modes() const { return (modes_.eigenvalues().array().abs() <= zero_).count(); }

    /// min over λ(C) of −2 Re λ/|λ|², the exact limit of explicit Euler for any D [T18]; 0 when an
    /// undamped mode allows none, infinity when there is nothing but zero modes.
    double explicit_limit() const { return limits().estimate; }
    /// The same from above: each λ may err by its condition number times the rounding of C, to
    /// first order; eigenvalues that this leaves undecided are passed over.
    double explicit_limit_above() const { return limits().above; }
    /// Largest |μ| of one step over all modes but the zero modes.
    double spectral_radius(Method method, double h) const;

private:
    struct Limits {
        double estimate = std::numeric_limits<double>::infinity();
        double above = std::numeric_limits<double>::infinity();
    };
    Limits limits() const;
    Eigen::MatrixXd generator() const;

    Eigen::VectorXd root_;  // √M
    Eigen::MatrixXd D_;     // M^-½ D M^-½
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes_;
    double zero_ = 0;
};

inline DenseAnalysis::DenseAnalysis(const Pencil& pencil, bool project)
    : root_(pencil.mass().cwiseSqrt()) {
    const auto scaled = [&](const Combination& c) {
        const Eigen::VectorXd inverse = root_.cwiseInverse();
        const Eigen::MatrixXd S = Eigen::MatrixXd(pencil.assemble(c));
        return Eigen::MatrixXd(inverse.asDiagonal() * S * inverse.asDiagonal());
    };
    D_ = scaled({0, 0, 1});
    modes_.compute(scaled({0, 1, 0, project}));
    const double norm = modes_.eigenvalues().cwiseAbs().maxCoeff();
    zero_ = 64 * static_cast<double>(pencil.size()) * std::numeric_limits<double>::epsilon() * norm;
}

/// C [T1] in energy coordinates y = √k x of the modes, [[0, S], [−S, −D]] with S = √k:
/// skew-symmetric but for D, so its eigenvalues are well conditioned under light damping. Zero
/// modes have no y, for no force depends on it; what is left of λ = 0 is simple.
inline Eigen::MatrixXd DenseAnalysis::generator() const {
    const Index N = root_.size();
    const Index r = N - zero_modes();
    // A permutation brings the zero modes last.
    Eigen::MatrixXd V(N, N);
    Eigen::VectorXd k(N);
    Index front = 0;
    Index back = r;
    for (Index j = 0; j < N; ++j) {
        const Index to = std::abs(modes_.eigenvalues()[j]) <= zero_ ? back++ : front++;
        V.col(to) = modes_.eigenvectors().col(j);
        k[to] = modes_.eigenvalues()[j];
    }
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(r + N, r + N);
    C.block(0, r, r, r).diagonal() = k.head(r).cwiseAbs().cwiseSqrt();
    C.block(r, 0, r, r).diagonal() =
        -k.head(r).cwiseSign().cwiseProduct(C.block(0, r, r, r).diagonal());
    C.bottomRightCorner(N, N) = -V.transpose() * D_ * V;
    return C;
}

inline DenseAnalysis::Limits DenseAnalysis::limits() const {
    const Eigen::MatrixXd C = generator();
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(C);
    const Eigen::MatrixXcd V = solver.eigenvectors();
    const Eigen::MatrixXcd W = V.partialPivLu().inverse();
    const double rounding =
        4 * static_cast<double>(C.rows()) * std::numeric_limits<double>::epsilon() * C.norm();
    const bool buckled = modes_.eigenvalues()[0] < -zero_;
    Limits limits;
    for (Index i = 0; i < C.rows(); ++i) {
        const std::complex<double> lambda = solver.eigenvalues()[i];
        if (std::abs(lambda) <= rounding) continue;  // a zero mode's velocity
        // The growth of a buckled system is not the step's [T27].
        if (buckled && lambda.real() > 0 && std::abs(lambda.imag()) <= 1e-6 * std::abs(lambda))
            continue;
        const double size = std::norm(lambda);
        limits.estimate = std::min(limits.estimate, std::max(0.0, -2 * lambda.real() / size));
        const double error = rounding * V.col(i).norm() * W.row(i).norm();
        const double least = std::abs(lambda) - error;
        if (!(least > std::abs(lambda) / 2)) continue;
        limits.above =
            std::min(limits.above, 2 * std::max(0.0, error - lambda.real()) / (least * least));
    }
    return limits;
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
            step.topRows(r) +=
                h * C.block(0, r, r, r).diagonal().asDiagonal() * step.middleRows(r, r);
            break;
        }
        case Method::implicit_euler: step = (I - h * C).partialPivLu().inverse(); break;
    }
    double radius = 0;
    for (const auto& mu : Eigen::VectorXcd(step.eigenvalues())) {
        // The velocity of an undamped zero mode: multiplier exactly 1.
        if (std::abs(mu - 1.0) <=
            64 * static_cast<double>(n) * std::numeric_limits<double>::epsilon()) {
            continue;
        }
        radius = std::max(radius, std::abs(mu));
    }
    return radius;
}

}  // namespace taut
