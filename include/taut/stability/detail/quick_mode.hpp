// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "../lanczos.hpp"
#include "../spring_pencil.hpp"

// The first search for an extreme mode of many springs: in single precision, since what is said of
// the vector that it finds is computed anew in double.

namespace taut::stability_detail {

/// A = M⁻½SM⁻½ of the springs' part of S in single precision, scaled so that nothing overflows:
/// 32 bytes a spring and no branch for pins.
template <int Dim>
class SinglePrecisionSprings {
public:
    SinglePrecisionSprings(const SpringPencil<Dim>& pencil, const Combination& c);

    Index size() const { return Dim * particles_; }
    /// y ← A q up to a factor, N.
    void multiply(const Eigen::VectorXf& q, Eigen::VectorXf& y);
    /// M⁻½q up to a factor, N.
    Eigen::VectorXd shape(const Eigen::VectorXf& q) const;
    /// M½u up to a factor, N: what shape() came from.
    Eigen::VectorXf coordinates(const Eigen::VectorXd& u) const {
        Eigen::VectorXf q(size());
        const double largest = u.cwiseAbs().maxCoeff();
        for (Index i = 0; i < size(); ++i) {
            q[i] = static_cast<float>(u[i] / largest) / inverse_root_[i / Dim];
        }
        return q;
    }

private:
    static constexpr int width = Dim == 3 ? 4 : Dim;  // floats of a particle: one SIMD register
    using Slot = Eigen::Matrix<float, width, 1>;
    struct Link {
        int a;  // particles_ when pinned
        int b;
        float difference;  // axial − transverse
        float transverse;
        Slot d;
    };
    static auto slot(Eigen::VectorXf& v, int i) {
        return Eigen::Map < Slot,
               width == 4 ? Eigen::Aligned16 : Eigen::Unaligned > (v.data() + width * i);
    }

    int particles_;
    Eigen::VectorXf inverse_root_;  // m^-½ relative to the lightest particle's
    std::vector<Link, Eigen::aligned_allocator<Link>> links_;
    Eigen::VectorXf u_;  // M⁻½q; a last particle, at rest, stands for all that are pinned
    Eigen::VectorXf f_;  // its forces
};

template <int Dim>
SinglePrecisionSprings<Dim>::SinglePrecisionSprings(const SpringPencil<Dim>& pencil,
                                                    const Combination& c)
    : particles_(static_cast<int>(pencil.size() / Dim)), inverse_root_(particles_) {
    const double lightest = pencil.mass().minCoeff();
    for (int i = 0; i < particles_; ++i) {
        inverse_root_[i] = static_cast<float>(std::sqrt(lightest / pencil.mass()[Dim * i]));
    }
    double stiffest = 0;
    pencil.for_each_link(c, [&](int, int, const auto&, double axial, double transverse) {
        stiffest = std::max({stiffest, std::abs(axial), std::abs(transverse)});
    });
    links_.reserve(static_cast<std::size_t>(pencil.link_count()));
    pencil.for_each_link(c, [&](int a, int b, const auto& d, double axial, double transverse) {
        Slot padded = Slot::Zero();
        padded.template head<Dim>() = d.template cast<float>();
        links_.push_back({a < 0 ? particles_ : a, b < 0 ? particles_ : b,
                          static_cast<float>((axial - transverse) / stiffest),
                          static_cast<float>(transverse / stiffest), padded});
    });
    u_.setZero(width * (particles_ + 1));
}

template <int Dim>
void SinglePrecisionSprings<Dim>::multiply(const Eigen::VectorXf& q, Eigen::VectorXf& y) {
    for (int i = 0; i < particles_; ++i) {
        for (int k = 0; k < Dim; ++k) u_[width * i + k] = inverse_root_[i] * q[Dim * i + k];
    }
    f_.setZero(u_.size());
    for (const Link& link : links_) {
        const Slot du = slot(u_, link.a) - slot(u_, link.b);
        const Slot pull = link.transverse * du + (link.difference * link.d.dot(du)) * link.d;
        slot(f_, link.a) += pull;
        slot(f_, link.b) -= pull;
    }
    y.resize(size());
    for (int i = 0; i < particles_; ++i) {
        for (int k = 0; k < Dim; ++k) y[Dim * i + k] = inverse_root_[i] * f_[width * i + k];
    }
}

template <int Dim>
Eigen::VectorXd SinglePrecisionSprings<Dim>::shape(const Eigen::VectorXf& q) const {
    Eigen::VectorXd u(size());
    for (int i = 0; i < particles_; ++i) {
        u.template segment<Dim>(Dim * i) =
            (inverse_root_[i] * q.template segment<Dim>(Dim * i)).template cast<double>();
    }
    return u;
}

/// The plain Lanczos process [B. N. Parlett, The symmetric eigenvalue problem, ch. 13] until the
/// largest Ritz value's residual is `tolerance` of it; at so rough a tolerance the basis needs no
/// reorthogonalisation.
/// @param multiply  y ← A q
/// @param q  where to begin, of unit length
/// @returns the vector, or an empty one when the steps were not enough
template <class Real = float>  // a template: only its callers compile it
Eigen::VectorXf quick_vector(
    const std::function<void(const Eigen::VectorXf& q, Eigen::VectorXf& y)>& multiply,
    Eigen::VectorXf q) {
    constexpr int most = 24;
    constexpr int least = 8;  // steps before the first look
    constexpr double tolerance = 2e-2;
    const Index N = q.size();
    Basis<float> Q(N, most);
    std::vector<double> alpha;  // diagonal of the tridiagonal QᵀAQ
    std::vector<double> beta;   // its off-diagonal
    VectorX<Real> w;
    for (int j = 0; j < most; ++j) {
        Q.set(j, q);
        multiply(q, w);
        const float along = dot(q.data(), w.data(), N);
        add_scaled(w.data(), -along, q.data(), N);
        if (j > 0) add_scaled(w.data(), -static_cast<float>(beta.back()), Q[j - 1], N);
        const float length = norm(w.data(), N);
        if (!(length > 0) || !std::isfinite(length)) return {};
        q = w / length;
        alpha.push_back(along);
        beta.push_back(length);
        if (j % 2 == 0 || j + 1 < least) continue;
        const std::vector<double> off_diagonal(beta.begin(), beta.end() - 1);
        std::vector<double> last_row(alpha.size(), 0);
        last_row.back() = 1;
        const auto ends = tridiagonal_spectrum(alpha, off_diagonal, last_row);
        if (beta.back() * std::abs(*ends.vector(j)) <= tolerance * ends.values.back()) {
            const auto ritz =
                tridiagonal_spectrum(alpha, off_diagonal, small_identity(alpha.size()));
            return Q.sum(ritz.vector(j), j + 1);
        }
    }
    return {};
}

/// @param start  N, an approximate mode to begin with, or empty; a scattered vector is mixed in, or
///               an eigenvector that no longer leads would be found again and nothing else
/// @returns u, N, of any length; empty when the steps were not enough
template <int Dim>
Eigen::VectorXd quick_mode(const SpringPencil<Dim>& pencil, const Combination& c,
                           const Eigen::VectorXd& start = {}) {
    SinglePrecisionSprings<Dim> A(pencil, c);
    Eigen::VectorXf q = scattered_vector(pencil.size()).template cast<float>().normalized();
    if (start.size() == A.size()) q += 4.F * A.coordinates(start).normalized();
    q.normalize();
    q = quick_vector([&](const Eigen::VectorXf& u, Eigen::VectorXf& y) { A.multiply(u, y); }, q);
    return q.size() > 0 ? A.shape(q) : Eigen::VectorXd();
}

/// An approximate pair of the largest eigenvalue, as largest_ritz_pair gives it: for many springs
/// at a third of the cost.
template <int Dim>
RitzPair leading_pair(const SpringPencil<Dim>& pencil, const Combination& c,
                      const Eigen::VectorXd& start = {}) {
    constexpr Index few = 300;  // unknowns: below, neither search takes long
    Eigen::VectorXd u;
    if (pencil.size() >= few) u = quick_mode(pencil, c, start);
    const double m = u.size() > 0 ? u.dot(pencil.mass().cwiseProduct(u)) : 0;
    if (!(m > 0) || !std::isfinite(m)) return largest_ritz_pair(pencil, c, {}, start);
    u /= std::sqrt(m);
    RitzPair pair;
    pair.value = pencil.quadratic(c, u).value;
    pair.vector = std::move(u);
    return pair;
}

}  // namespace taut::stability_detail
