// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <complex>

#include "../proof/pencil_matrix.hpp"
#include "detail/step_matrix.hpp"

namespace taut {

/// Full eigenvalue computations for small systems: O(N³), good to rounding, numerical (no proof).
/// Modes of K whose eigenvalue is zero to rounding are zero modes and are
/// left out of limits and radii.
/// @tparam Real  the precision: double, or long double for a referee
template <class Real = double>
class DenseAnalysis {
public:
    using Vector = VectorX<Real>;
    using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

    /// Degrees of freedom up to which all this takes little time.
    static constexpr Index good_size = 120;

    /// @param stiffness  K_plus or K
    explicit DenseAnalysis(const Pencil& pencil, const Combination& stiffness = matrices::K_plus);

    /// Eigenvalues of K'⁺, ascending, 1/s².
    const Vector& stiffness_eigenvalues() const { return modes_.eigenvalues(); }
    /// Eigenvectors in the coordinates u: column j has uᵀMu = 1.
    Vector mode(Index j) const { return modes_.eigenvectors().col(j).cwiseQuotient(root_); }
    /// Eigenvalues with |k| ≤ this are zero modes.
    Real zero_tolerance() const { return zero_; }
    /// How many these are.
    Index zero_modes() const { return (modes_.eigenvalues().cwiseAbs().array() <= zero_).count(); }

    /// min over λ(C) of −2 Re λ/|λ|², the exact limit of explicit Euler for any D [T18]; 0 when an
    /// undamped mode allows none, infinity when there is nothing but zero modes.
    Real explicit_limit() const { return limits().estimate; }
    /// The same from above: each λ may err by its condition number times the rounding of C, to
    /// first order; eigenvalues that this leaves undecided are passed over.
    Real explicit_limit_above() const { return limits().above; }
    /// Largest |μ| of one step over all modes but the zero modes; BDF2 has 1/3 on these, too.
    Real spectral_radius(Method method, Real h) const;

private:
    struct Limits {
        Real estimate = std::numeric_limits<Real>::infinity();
        Real above = std::numeric_limits<Real>::infinity();
    };
    Limits limits() const;
    Matrix generator() const;

    Vector root_;  // √M
    Matrix D_;     // M^-½ D M^-½
    Eigen::SelfAdjointEigenSolver<Matrix> modes_;
    Real zero_ = 0;
};

template <class Real>
DenseAnalysis<Real>::DenseAnalysis(const Pencil& pencil, const Combination& stiffness)
    : root_(pencil.mass().template cast<Real>().cwiseSqrt()) {
    const auto scaled = [&](const Combination& c) {
        const Vector inverse = root_.cwiseInverse();
        const Matrix S = pencil.assemble(c).toDense().template cast<Real>();
        return Matrix(inverse.asDiagonal() * S * inverse.asDiagonal());
    };
    D_ = scaled(matrices::D);
    modes_.compute(scaled(stiffness));
    const Real norm = modes_.eigenvalues().cwiseAbs().maxCoeff();
    zero_ = 64 * static_cast<Real>(pencil.size()) * std::numeric_limits<Real>::epsilon() * norm;
}

/// C [T1] in energy coordinates y = √k x of the modes, [[0, S], [−S, −D]] with S = √k:
/// skew-symmetric but for D, so its eigenvalues are well conditioned under light damping. Zero
/// modes have no y, for no force depends on it; what is left of λ = 0 is simple.
template <class Real>
auto DenseAnalysis<Real>::generator() const -> Matrix {
    const Index N = root_.size();
    const Index r = N - zero_modes();
    // A permutation brings the zero modes last.
    Matrix V(N, N);
    Vector k(N);
    Index front = 0;
    Index back = r;
    for (Index j = 0; j < N; ++j) {
        const Index to = (std::abs)(modes_.eigenvalues()[j]) <= zero_ ? back++ : front++;
        V.col(to) = modes_.eigenvectors().col(j);
        k[to] = modes_.eigenvalues()[j];
    }
    Matrix C = Matrix::Zero(r + N, r + N);
    C.block(0, r, r, r).diagonal() = k.head(r).cwiseAbs().cwiseSqrt();
    C.block(r, 0, r, r).diagonal() =
        -k.head(r).cwiseSign().cwiseProduct(C.block(0, r, r, r).diagonal());
    C.bottomRightCorner(N, N) = -V.transpose() * D_ * V;
    return C;
}

template <class Real>
auto DenseAnalysis<Real>::limits() const -> Limits {
    using ComplexMatrix = Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, Eigen::Dynamic>;
    const Matrix C = generator();
    const Eigen::EigenSolver<Matrix> solver(C);
    const ComplexMatrix V = solver.eigenvectors();
    const ComplexMatrix W = V.partialPivLu().inverse();
    const Real rounding =
        4 * static_cast<Real>(C.rows()) * std::numeric_limits<Real>::epsilon() * C.norm();
    const bool buckled = modes_.eigenvalues()[0] < -zero_;
    Limits limits;
    for (Index i = 0; i < C.rows(); ++i) {
        const std::complex<Real> lambda = solver.eigenvalues()[i];
        if ((std::abs)(lambda) <= rounding) continue;  // a zero mode's velocity
        const Real error = rounding * V.col(i).norm() * W.row(i).norm();
        // The growth of a buckled system is not the step's [T27]. It is real, but two that are
        // nearly equal may round to a complex pair.
        if (buckled && lambda.real() > 0 &&
            (std::abs)(lambda.imag()) <= (std::max)(error, Real(1e-6) * (std::abs)(lambda)))
            continue;
        const Real size = std::norm(lambda);
        limits.estimate =
            (std::min)(limits.estimate, (std::max)(Real(0), -2 * lambda.real() / size));
        const Real least = -error + (std::abs)(lambda);
        if (!(least > (std::abs)(lambda) / 2)) continue;
        limits.above = (std::min)(limits.above,
                                  2 * (std::max)(Real(0), error - lambda.real()) / (least * least));
    }
    return limits;
}

template <class Real>
Real DenseAnalysis<Real>::spectral_radius(Method method, Real h) const {
    using ComplexVector = Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, 1>;
    const Matrix C = generator();
    const Index n = C.rows();
    const Index r = n - root_.size();
    const Matrix step = method::visit(
        method, [&](auto descriptor) { return method::step_matrix(descriptor, C, h, r); });
    Real radius = 0;
    for (const auto& mu : ComplexVector(step.eigenvalues())) {
        // The velocity of an undamped zero mode: multiplier exactly 1.
        if ((std::abs)(mu - Real(1)) <=
            64 * static_cast<Real>(n) * std::numeric_limits<Real>::epsilon()) {
            continue;
        }
        radius = (std::max)(radius, (std::abs)(mu));
    }
    return radius;
}

}  // namespace taut
