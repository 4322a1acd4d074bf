// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <string>
#include <taut/core/method.hpp>
#include <taut/scene/chain.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/stability/stability.hpp>
#include <utility>
#include <vector>

#include "random.hpp"

// The referee of the stability tests: matrices and multipliers in long double, written from the
// theory's equations with nothing of the library's analysis in them, and the scenes to judge.

namespace taut_test {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using ComplexVector = Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, 1>;

constexpr Real real_epsilon = std::numeric_limits<Real>::epsilon();

/// Spread evenly over orders of magnitude.
inline double log_uniform(Random& random, double low, double high) {
    return std::exp2(random.uniform(std::log2(low), std::log2(high)));
}

/// M, K, K⁺, D of the free degrees of freedom [T1], [T2], [T27], [T28].
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
            if (l == 0) {
                const RealMatrix H = Law::stiffness_bound(p, L) * one;
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

/// The same system with an axial damper of `ratio`·stiffness, N·s/m, on every spring.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> with_dampers(const taut::SpringSystem<Scalar, Dim>& system,
                                             double ratio) {
    taut::SpringSystem<Scalar, Dim> copy;
    const auto state = system.initial_state();
    for (Index i = 0; i < system.size(); ++i) copy.add_particle(state.x.col(i), system.mass(i));
    const auto& set = system.springs();
    for (std::size_t s = 0; s < set.a.size(); ++s) {
        const auto damping =
            static_cast<Scalar>(ratio * static_cast<double>(set.parameters[s].stiffness));
        copy.add_spring(taut::Spring<Scalar, taut::Hookean>{set.a[s], set.b[s], set.parameters[s],
                                                            set.rest_length[s], damping});
    }
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) copy.pin(i);
    }
    copy.set_gravity(system.gravity());
    return copy;
}

/// Every coordinate multiplied by `factor`, then moved by up to `noise`.
template <class System>
typename System::State deformed(const System& system, double factor, double noise,
                                std::uint32_t seed) {
    using Scalar = typename System::Scalar;
    Random random(seed);
    auto state = system.initial_state();
    state.x *= static_cast<Scalar>(factor);
    state.x += random.points<Scalar, System::Dim>(system.size(), -noise, noise);
    return state;
}

/// visit(name, system, state) for scenes of all dimensions, small enough for dense eigenvalues.
template <class Scalar, class Visit>
void for_each_scene(Visit&& visit) {
    using taut::ChainEnds;
    const auto at_rest = [&](const char* name, const auto& system) {
        visit(std::string(name), system, system.initial_state());
    };
    taut::ChainOptions chain;
    chain.masses = 5;
    chain.mass = 0.1;
    chain.stiffness = 300;
    const auto ends = [&chain](ChainEnds e) {
        chain.ends = e;
        return chain;
    };
    at_rest("chain 1d, fixed-fixed", taut::chain<Scalar, 1>(ends(ChainEnds::fixed_fixed)));
    at_rest("chain 1d, fixed-free", taut::chain<Scalar, 1>(ends(ChainEnds::fixed_free)));
    at_rest("chain 1d, free-free", taut::chain<Scalar, 1>(ends(ChainEnds::free_free)));
    at_rest("ring 1d", taut::chain<Scalar, 1>(ends(ChainEnds::ring)));
    at_rest("ring 2d", taut::chain<Scalar, 2>(ends(ChainEnds::ring)));
    at_rest("chain 3d, fixed-free", taut::chain<Scalar, 3>(ends(ChainEnds::fixed_free)));
    const auto row = taut::chain<Scalar, 2>(ends(ChainEnds::fixed_fixed));
    visit("chain 2d, stretched", row, deformed(row, 1.5, 0.02, 1));
    visit("chain 2d, compressed", row, deformed(row, 0.8, 0.02, 2));
    chain.zero_rest_length = true;
    at_rest("chain 3d, zero rest length", taut::chain<Scalar, 3>(ends(ChainEnds::fixed_fixed)));
    chain.spacing = 0;
    at_rest("chain 1d, all in one point", taut::chain<Scalar, 1>(ends(ChainEnds::fixed_free)));
    at_rest("chain 2d, all in one point", taut::chain<Scalar, 2>(ends(ChainEnds::free_free)));
    chain.spacing = 1;
    chain.stiffness = 0;
    at_rest("chain 2d, no stiffness", taut::chain<Scalar, 2>(ends(ChainEnds::fixed_free)));

    taut::SpringSystem<Scalar, 3> alone;
    alone.add_particle({1, 2, 3}, Scalar(0.5));
    at_rest("a single particle", alone);
    taut::SpringSystem<Scalar, 1> one;
    one.add_particle(Eigen::Matrix<Scalar, 1, 1>(Scalar(0)), Scalar(1));
    one.add_particle(Eigen::Matrix<Scalar, 1, 1>(Scalar(1)), Scalar(0.01));
    one.add_spring(0, 1, Scalar(1e4));
    one.pin(0);
    at_rest("one mass on one spring", one);
    auto held = one;
    held.pin(1);
    at_rest("everything pinned", held);

    taut::ClothOptions cloth;
    cloth.rows = cloth.columns = 3;
    const auto grid = taut::hanging_cloth<Scalar>(cloth);
    visit("cloth, flat", grid, grid.initial_state());
    visit("cloth, stretched", grid, deformed(grid, 1.1, 0.01, 3));
    visit("cloth, compressed", grid, deformed(grid, 0.9, 0.01, 4));
    visit("cloth, crumpled", grid, deformed(grid, 0.3, 0.3, 5));
    cloth.pin_corners = false;
    cloth.rows = 2;
    const auto flying = taut::hanging_cloth<Scalar>(cloth);
    visit("cloth, free-flying", flying, flying.initial_state());
    visit("cloth, free-flying and wrinkled", flying, deformed(flying, 1.02, 0.05, 6));
    cloth.zero_rest_length = true;
    cloth.diagonals = false;
    cloth.pin_corners = true;
    const auto linear = taut::hanging_cloth<Scalar>(cloth);
    visit("grid of zero rest length", linear, linear.initial_state());
}

/// visit(name, damped system) for each kind of damping; `omega` is the scale of its frequencies.
template <class System, class Visit>
void for_each_damping(const System& system, double omega, Visit&& visit) {
    const auto rayleigh = [&](const char* name, System copy, double d0, double alpha) {
        copy.set_rayleigh({d0 * omega, alpha / omega});
        visit(std::string(name), copy);
    };
    rayleigh("no damping", system, 0, 0);
    rayleigh("d0", system, 0.25, 0);
    rayleigh("strong d0", system, 6, 0);
    rayleigh("alpha", system, 0, 0.1);
    rayleigh("strong alpha", system, 0, 5);
    rayleigh("d0 and alpha", system, 0.2, 0.3);
    rayleigh("dampers", with_dampers(system, 0.2 / omega), 0, 0);
    rayleigh("dampers and d0", with_dampers(system, 0.5 / omega), 0.3, 0);
    rayleigh("dampers, d0 and alpha", with_dampers(system, 2 / omega), 0.1, 0.2);
}

/// A scene with its damping, ready to be judged.
template <class Scalar>
struct StabilityCase {
    std::string text;
    Exact exact;
    taut::Stability<Scalar> stability;
    std::uint64_t revision;
    std::optional<taut::LinearSystem<Scalar>>
        linear;  ///< without load; none if everything is pinned

    Multipliers multipliers() const { return Multipliers(exact); }
};

template <class Scalar, class System>
StabilityCase<Scalar> stability_case(std::string text, const System& system,
                                     const typename System::State& state) {
    StabilityCase<Scalar> c{std::move(text),
                            exact_matrices(system, state.x),
                            {system, state},
                            system.revision(),
                            std::nullopt};
    if (system.pinned_count() < system.size()) {
        const auto linear = system.linearize(state);
        c.linear.emplace(linear.mass(), linear.damping(), linear.stiffness());
    }
    return c;
}

/// Every scene, undamped; or with every damping.
template <class Scalar>
std::vector<StabilityCase<Scalar>> stability_cases(bool with_damping) {
    std::vector<StabilityCase<Scalar>> cases;
    for_each_scene<Scalar>([&](const std::string& scene, const auto& system, const auto& state) {
        if (!with_damping) {
            cases.push_back(stability_case<Scalar>(scene, system, state));
            return;
        }
        const double omega = Multipliers(exact_matrices(system, state.x)).omega();
        for_each_damping(system, omega, [&](const std::string& damping, const auto& damped) {
            cases.push_back(stability_case<Scalar>(scene + ", " + damping, damped, state));
        });
    });
    return cases;
}

/// A random symmetric matrix with the given eigenvalues.
inline Eigen::MatrixXd with_spectrum(Random& random, const Eigen::VectorXd& spectrum) {
    const Index N = spectrum.size();
    Eigen::MatrixXd G(N, N);
    for (Index i = 0; i < N * N; ++i) G.data()[i] = random.uniform(-1, 1);
    const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(G).householderQ();
    const Eigen::MatrixXd A = Q * spectrum.asDiagonal() * Q.transpose();
    return 0.5 * (A + A.transpose());
}

template <class Scalar = double, class Dense>
Eigen::SparseMatrix<Scalar> sparse(const Dense& A) {
    return A.template cast<Scalar>().eval().sparseView();
}

}  // namespace taut_test
