// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "support/referee.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace taut_test {

RealMatrix Exact::scaled(Real on_mass, Real on_stiffness, Real on_damping, bool project) const {
    RealMatrix S = on_stiffness * (project ? K_plus : K) + on_damping * D;
    S.diagonal() += on_mass * mass;
    const RealVector inverse = mass.cwiseSqrt().cwiseInverse();
    return inverse.asDiagonal() * S * inverse.asDiagonal();
}

Exact Exact::zero(Index N) {
    const RealMatrix zero = RealMatrix::Zero(N, N);
    return {RealVector::Zero(N), zero, zero, zero};
}

void Exact::add(Index a, Index b, const ExactSpring& spring) {
    const Index Dim = spring.dx.size();
    const auto add = [&](RealMatrix& A, const RealMatrix& H) {
        if (a >= 0) A.block(Dim * a, Dim * a, Dim, Dim) += H;
        if (b >= 0) A.block(Dim * b, Dim * b, Dim, Dim) += H;
        if (a < 0 || b < 0) return;
        A.block(Dim * a, Dim * b, Dim, Dim) -= H;
        A.block(Dim * b, Dim * a, Dim, Dim) -= H;
    };
    const RealMatrix one = RealMatrix::Identity(Dim, Dim);
    const RealMatrix bound = spring.stiffness_bound * one;
    const Real squared = spring.dx.squaredNorm();
    if (squared == 0) {
        add(K, bound);
        add(K_plus, bound);
        return;
    }
    const RealMatrix along = spring.dx * spring.dx.transpose() / squared;
    const auto block = [&](Real axial, Real across) {
        return RealMatrix(axial * along + across * (one - along));
    };
    add(K, block(spring.axial, spring.across));
    add(K_plus, block(std::max(spring.axial, Real(0)), std::max(spring.across, Real(0))));
    add(D, spring.damping * along);
}

void Exact::add_rayleigh(Real mass_proportional, Real stiffness_proportional) {
    D += stiffness_proportional * K_plus;
    D.diagonal() += mass_proportional * mass;
}

namespace {

/// Masses in place, and to each particle its place among the free ones, −1: pinned.
std::vector<Index> free_places(const Scene& scene, int dim, Exact& e) {
    std::vector<Index> place;
    Index count = 0;
    for (Index i = 0; i < scene.size(); ++i) place.push_back(scene.is_pinned(i) ? -1 : count++);
    e = Exact::zero(dim * count);
    for (Index i = 0; i < scene.size(); ++i) {
        if (place[i] >= 0) e.mass.segment(dim * place[i], dim).setConstant(scene.mass(i));
    }
    return place;
}

}  // namespace

Exact exact_matrices(const Scene& scene, const Eigen::MatrixXd& x) {
    Exact e;
    const auto place = free_places(scene, scene.dim(), e);
    for (const AnySpring& s : scene.springs()) {
        const RealVector dx = x.col(s.b).cast<Real>() - x.col(s.a).cast<Real>();
        const Real l = dx.norm();
        const LawAt law = law_at(s, l);
        e.add(place[s.a], place[s.b],
              {dx, law.bound, l == 0 ? 0 : law.slope,
               l == 0 || scene.dim() == 1 ? 0 : law.tension / l, s.damping});
    }
    e.add_rayleigh(scene.mass_proportional(), scene.stiffness_proportional());
    return e;
}

Exact exact_laplacians(const Scene& scene) {
    Exact e;
    const auto place = free_places(scene, 1, e);
    for (const AnySpring& s : scene.springs()) {
        const Real bound = law_at(s, s.rest_length).bound;
        e.add(place[s.a], place[s.b], {RealVector::Ones(1), bound, bound, 0, s.damping});
    }
    e.add_rayleigh(scene.mass_proportional(), scene.stiffness_proportional());
    return e;
}

Multipliers::Multipliers(const Exact& e, Real zero)
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
    const auto modes = taut_test::modes(K_);
    const RealVector& k = modes.values;
    R_.resize(N, N);
    Index r = 0;
    for (Index j = 0; j < N; ++j) {
        if (std::abs(k[j]) > zero) R_.col(r++) = modes.vectors.col(j);
        least_ = std::min(least_, k[j]);
    }
    R_.conservativeResize(N, r);
    buckled_ = least_ < -zero;
}

RealMatrix Multipliers::step(taut::Method method, double seconds) const {
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
        v = solve(one + h * D_ + h * h * K_plus_, v);
    }
    A.bottomRows(N) = v;
    if (method == taut::Method::explicit_euler) {
        A.topRightCorner(r, N) = h * R_.transpose();
    } else {
        A.topRows(r) += h * R_.transpose() * v;
    }
    return A;
}

ComplexVector Multipliers::operator()(taut::Method method, double h) const {
    const RealMatrix A = step(method, h);
    if (A.rows() == 0) return {};
    return general_eigenvalues(A);
}

double Multipliers::explicit_limit() const {
    auto limit = std::numeric_limits<Real>::infinity();
    if (R_.rows() == 0) return static_cast<double>(limit);
    RealMatrix C = step(taut::Method::explicit_euler, 1 / omega());
    C.diagonal().array() -= 1;
    for (const auto& lambda : general_eigenvalues(C)) {
        if (std::abs(lambda) < 1e4L * real_epsilon || physical(lambda)) continue;
        limit = std::min(limit, std::max(Real(0), -2 * lambda.real() / std::norm(lambda)));
    }
    return static_cast<double>(limit / omega_);
}

Real Multipliers::induced_radius(taut::Method method, double h) const {
    Real radius = 0;
    for (const auto& mu : (*this)(method, h)) {
        if (!physical(mu)) radius = std::max(radius, std::abs(mu));
    }
    return radius;
}

Real Multipliers::radius(taut::Method method, double h) const {
    Real radius = 0;
    for (const auto& mu : (*this)(method, h)) radius = std::max(radius, std::abs(mu));
    return radius;
}

RealVector Multipliers::position(const RealVector& y) const {
    return (R_ * y.head(R_.cols()) / omega_).cwiseQuotient(root_);
}

RealVector Multipliers::velocity(const RealVector& y) const {
    return y.tail(R_.rows()).cwiseQuotient(root_);
}

RealVector Multipliers::reduced_position(const RealVector& x) const {
    return omega_ * (R_.transpose() * root_.cwiseProduct(x));
}

double definite_limit(const Exact& e, Real sign, bool project) {
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
    for (const auto& value : general_eigenvalues(A)) {
        if (std::abs(value.imag()) < 1e-8L) s = std::max(s, value.real());
    }
    return s > 0 ? static_cast<double>(1 / (s * omega)) : std::numeric_limits<double>::infinity();
}

}  // namespace taut_test
