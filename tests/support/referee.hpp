// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <taut/method/method.hpp>
#include <taut/stability/stability.hpp>
#include <utility>
#include <vector>

#include "random.hpp"

// The referee of the stability tests: matrices and multipliers in long double, written from the
// theory's equations with nothing of the library's analysis in them.

namespace taut_test {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using ComplexVector = Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, 1>;

constexpr Real real_epsilon = std::numeric_limits<Real>::epsilon();

/// M, K, K⁺, D of the free degrees of freedom [T1], [T2], [T27], [T28], [T34].
struct Exact {
    RealVector mass;
    RealMatrix K;
    RealMatrix K_plus;
    RealMatrix D;

    Eigen::Index size() const { return mass.size(); }
    /// mass·M + stiffness·K (or K⁺) + damping·D, as M^-½ S M^-½: similar to M⁻¹S.
    RealMatrix scaled(Real on_mass, Real on_stiffness, Real on_damping, bool project) const {
        RealMatrix S = on_stiffness * (project ? K_plus : K) + on_damping * D;
        S.diagonal() += on_mass * mass;
        const RealVector inverse = mass.cwiseSqrt().cwiseInverse();
        return inverse.asDiagonal() * S * inverse.asDiagonal();
    }
};

inline RealVector eigenvalues(const RealMatrix& A) {
    return Eigen::SelfAdjointEigenSolver<RealMatrix>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

template <class System, class Pose>
Exact exact_matrices(const System& system, const Pose& pose) {
    constexpr int Dim = System::Dim;
    std::vector<Index> block;
    Index count = 0;
    for (Index i = 0; i < system.size(); ++i) block.push_back(system.is_pinned(i) ? -1 : count++);
    const Index N = Dim * count;
    Exact e{RealVector(N), RealMatrix::Zero(N, N), RealMatrix::Zero(N, N), RealMatrix::Zero(N, N)};
    for (Index i = 0; i < system.size(); ++i) {
        if (block[i] >= 0)
            e.mass.segment(Dim * block[i], Dim).setConstant(static_cast<Real>(system.mass(i)));
    }
    const RealMatrix x = pose.template cast<Real>();
    const RealMatrix one = RealMatrix::Identity(Dim, Dim);
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const Index a = block[set.a[s]];
            const Index b = block[set.b[s]];
            const auto p = set.parameters[s].template cast<Real>();
            const auto L = static_cast<Real>(set.rest_length[s]);
            const RealVector dx = x.col(set.b[s]) - x.col(set.a[s]);
            const Real l = dx.norm();
            const auto add = [&](RealMatrix& A, const RealMatrix& H) {
                if (a >= 0) A.block(Dim * a, Dim * a, Dim, Dim) += H;
                if (b >= 0) A.block(Dim * b, Dim * b, Dim, Dim) += H;
                if (a < 0 || b < 0) return;
                A.block(Dim * a, Dim * b, Dim, Dim) -= H;
                A.block(Dim * b, Dim * a, Dim, Dim) -= H;
            };
            const RealMatrix bound = Law::stiffness_bound(p, L) * one;
            add(e.D, static_cast<Real>(system.graph_damping()) * bound);
            if (l == 0) {
                const RealMatrix& H = bound;
                add(e.K, H);
                add(e.K_plus, H);
                continue;
            }
            const RealMatrix along = dx * dx.transpose() / (l * l);
            const Real axial = Law::tension_slope(p, L, l);
            const Real across = Dim == 1 ? 0 : Law::tension(p, L, l) / l;
            add(e.K, axial * along + across * (one - along));
            add(e.K_plus,
                std::max(axial, Real(0)) * along + std::max(across, Real(0)) * (one - along));
            add(e.D, static_cast<Real>(set.damping_of(s)) * along);
        }
    });
    const auto rayleigh = system.rayleigh();
    e.D += static_cast<Real>(rayleigh.stiffness_proportional) * e.K_plus;
    e.D.diagonal() += static_cast<Real>(rayleigh.mass_proportional) * e.mass;
    return e;
}

/// Of bare matrices: K⁺ = K.
template <class Scalar>
Exact exact_matrices(const taut::LinearSystem<Scalar>& system) {
    const RealMatrix K = system.stiffness().template cast<Real>();
    return {system.mass().template cast<Real>(), K, K,
            RealMatrix(system.damping().template cast<Real>())};
}

/// The transition matrices [T4]–[T6], [T27] of a system with its zero modes projected out, and
/// their eigenvalues. Coordinates are free of units: positions M^½x·ω, velocities M^½v, steps hω.
class Multipliers {
public:
    /// @param zero  eigenvalues of K' up to this, relative to the largest, are zero modes
    explicit Multipliers(const Exact& e, Real zero = 1e-13L)
        : root_(e.mass.cwiseSqrt()),
          K_(e.scaled(0, 1, 0, false)),
          K_plus_(e.scaled(0, 1, 0, true)),
          D_(e.scaled(0, 0, 1, false)) {
        const Index N = e.size();
        Real norm = 0;
        if (N > 0) norm = std::max(K_plus_.cwiseAbs().maxCoeff(), K_.cwiseAbs().maxCoeff());
        omega_ = norm > 0                                ? std::sqrt(norm)
                 : N > 0 && D_.cwiseAbs().maxCoeff() > 0 ? D_.cwiseAbs().maxCoeff()
                                                         : 1;
        K_ /= omega_ * omega_;
        K_plus_ /= omega_ * omega_;
        D_ /= omega_;
        if (N == 0) return;
        const Eigen::SelfAdjointEigenSolver<RealMatrix> modes(K_);
        const RealVector& k = modes.eigenvalues();
        R_.resize(N, N);
        Index r = 0;
        for (Index j = 0; j < N; ++j) {
            if (std::abs(k[j]) > zero) R_.col(r++) = modes.eigenvectors().col(j);
            least_ = std::min(least_, k[j]);
        }
        R_.conservativeResize(N, r);
        buckled_ = least_ < -zero;
    }

    /// A frequency of the size of the largest, rad/s.
    double omega() const { return static_cast<double>(omega_); }
    /// √κ, 1/s.
    double growth_rate() const {
        return buckled_ ? static_cast<double>(std::sqrt(-least_) * omega_) : 0;
    }
    bool buckled() const { return buckled_; }
    Index zero_modes() const { return R_.rows() - R_.cols(); }

    RealMatrix step(taut::Method method, double seconds) const {
        const Index N = R_.rows();
        const Index r = R_.cols();
        const Real h = static_cast<Real>(seconds) * omega_;
        RealMatrix A = RealMatrix::Identity(r + N, r + N);
        if (N == 0) return A;
        const RealMatrix one = RealMatrix::Identity(N, N);
        RealMatrix v(N, r + N);  // the new velocity of every old state
        v.leftCols(r) = -h * (K_ * R_);
        v.rightCols(N) = one - h * D_;
        if (method == taut::Method::implicit_euler) {
            v.rightCols(N) = one;
            v = (one + h * D_ + h * h * K_plus_).fullPivLu().solve(v).eval();
        }
        A.bottomRows(N) = v;
        if (method == taut::Method::explicit_euler) {
            A.topRightCorner(r, N) = h * R_.transpose();
        } else {
            A.topRows(r) += h * R_.transpose() * v;
        }
        return A;
    }
    ComplexVector operator()(taut::Method method, double h) const {
        const RealMatrix A = step(method, h);
        if (A.rows() == 0) return {};
        return Eigen::EigenSolver<RealMatrix>(A, false).eigenvalues();
    }
    /// The largest stable step of explicit Euler: μ = 1 + hλ, so min −2 Re λ/|λ|² [T18].
    double explicit_limit() const {
        auto limit = std::numeric_limits<Real>::infinity();
        if (R_.rows() == 0) return static_cast<double>(limit);
        RealMatrix C = step(taut::Method::explicit_euler, 1 / omega());
        C.diagonal().array() -= 1;
        for (const auto& lambda :
             ComplexVector(Eigen::EigenSolver<RealMatrix>(C, false).eigenvalues())) {
            if (std::abs(lambda) < 1e4L * real_epsilon || physical(lambda)) continue;
            limit = std::min(limit, std::max(Real(0), -2 * lambda.real() / std::norm(lambda)));
        }
        return static_cast<double>(limit / omega_);
    }
    /// Whether μ is growth of the physics: real and positive, while K is indefinite [T27].
    bool physical(const std::complex<Real>& mu) const {
        return buckled_ && mu.real() > 0 && std::abs(mu.imag()) < 1e-6L;
    }
    /// The largest modulus but for the physics.
    Real induced_radius(taut::Method method, double h) const {
        Real radius = 0;
        for (const auto& mu : (*this)(method, h)) {
            if (!physical(mu)) radius = std::max(radius, std::abs(mu));
        }
        return radius;
    }
    Real radius(taut::Method method, double h) const {
        Real radius = 0;
        for (const auto& mu : (*this)(method, h)) radius = std::max(radius, std::abs(mu));
        return radius;
    }
    /// How well a multiplier is computed that is not too close to another one.
    static constexpr Real tolerance = 1e6L * real_epsilon;

    // Between the coordinates of step() and metres: x = M^-½ R y/ω, v = M^-½ v̂.
    RealVector position(const RealVector& y) const {
        return (R_ * y.head(R_.cols()) / omega_).cwiseQuotient(root_);
    }
    RealVector velocity(const RealVector& y) const {
        return y.tail(R_.rows()).cwiseQuotient(root_);
    }
    RealVector reduced_position(const RealVector& x) const {
        return omega_ * (R_.transpose() * root_.cwiseProduct(x));
    }

private:
    RealVector root_;  // √M
    RealMatrix K_;     // K'/ω², K'⁺/ω², D'/ω
    RealMatrix K_plus_;
    RealMatrix D_;
    RealMatrix R_;  // N × r, the modes that are not zero modes
    Real omega_ = 1;
    Real least_ = 0;
    bool buckled_ = false;
};

/// The smallest h at which 4M − 2hD − sign·h²K loses definiteness, with 1/h = s: the largest real s
/// of 4s²M − 2sD − sign·K [T19]; infinity if there is none.
inline double definite_limit(const Exact& e, Real sign, bool project) {
    const Index N = e.size();
    const RealMatrix K = e.scaled(0, 1, 0, project);
    const RealMatrix D = e.scaled(0, 0, 1, false);
    const Real omega = std::max(std::sqrt(K.cwiseAbs().maxCoeff()), D.cwiseAbs().maxCoeff());
    if (omega == 0) return std::numeric_limits<double>::infinity();
    RealMatrix A = RealMatrix::Zero(2 * N, 2 * N);
    A.topRightCorner(N, N).setIdentity();
    A.bottomLeftCorner(N, N) = sign * K / (4 * omega * omega);
    A.bottomRightCorner(N, N) = D / (2 * omega);
    Real s = 0;
    for (const auto& value :
         ComplexVector(Eigen::EigenSolver<RealMatrix>(A, false).eigenvalues())) {
        if (std::abs(value.imag()) < 1e-8L) s = std::max(s, value.real());
    }
    return s > 0 ? static_cast<double>(1 / (s * omega)) : std::numeric_limits<double>::infinity();
}

}  // namespace taut_test
