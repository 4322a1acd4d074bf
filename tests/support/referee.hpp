// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <taut/conditions/method.hpp>
#include <taut/own_matrices/linear_system.hpp>
#include <vector>

#include "decompositions.hpp"
#include "random.hpp"
#include "scene.hpp"

// The referee of the stability tests: matrices and multipliers in long double, written from the
// theory's equations with nothing of the library's analysis in them.

namespace taut_test {

constexpr Real real_epsilon = std::numeric_limits<Real>::epsilon();

/// What a spring adds to the matrices at a pose.
struct ExactSpring {
    RealVector dx;         ///< from a to b, m
    Real stiffness_bound;  ///< N/m
    Real axial;            ///< N/m
    Real across;           ///< N/m
    Real damping;          ///< N·s/m, along the spring
};

/// M, K, K⁺, D of the free degrees of freedom [T1], [T2], [T27], [T28].
struct Exact {
    RealVector mass;
    RealMatrix K;
    RealMatrix K_plus;
    RealMatrix D;

    Eigen::Index size() const { return mass.size(); }
    /// mass·M + stiffness·K (or K⁺) + damping·D, as M^-½ S M^-½: similar to M⁻¹S.
    RealMatrix scaled(Real on_mass, Real on_stiffness, Real on_damping, bool project) const;

    static Exact zero(Index degrees_of_freedom);
    /// @param a, b  which of the free particles, −1: none
    void add(Index a, Index b, const ExactSpring& spring);
    void add_rayleigh(Real mass_proportional, Real stiffness_proportional);
};

template <class System, class Pose>
Exact exact_matrices(const System& system, const Pose& pose) {
    constexpr int Dim = System::Dim;
    std::vector<Index> block;
    Index count = 0;
    for (Index i = 0; i < system.size(); ++i) block.push_back(system.is_pinned(i) ? -1 : count++);
    Exact e = Exact::zero(Dim * count);
    for (Index i = 0; i < system.size(); ++i) {
        if (block[i] >= 0)
            e.mass.segment(Dim * block[i], Dim).setConstant(static_cast<Real>(system.mass(i)));
    }
    const RealMatrix x = pose.template cast<Real>();
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const auto p = set.parameters[s].template cast<Real>();
            const auto L = static_cast<Real>(set.rest_length[s]);
            ExactSpring spring;
            spring.dx = x.col(set.b[s]) - x.col(set.a[s]);
            const Real l = spring.dx.norm();
            spring.stiffness_bound = Law::stiffness_bound(p, L);
            spring.axial = l == 0 ? 0 : Law::tension_slope(p, L, l);
            spring.across = l == 0 || Dim == 1 ? 0 : Law::tension(p, L, l) / l;
            spring.damping = static_cast<Real>(set.damping_of(s));
            e.add(block[set.a[s]], block[set.b[s]], spring);
        }
    });
    const auto rayleigh = system.rayleigh();
    e.add_rayleigh(static_cast<Real>(rayleigh.mass_proportional),
                   static_cast<Real>(rayleigh.stiffness_proportional));
    return e;
}

/// Of a scene in pose x.
Exact exact_matrices(const Scene& scene, const Eigen::MatrixXd& x);
/// M, L_k as K and K⁺, and L_c with Rayleigh damping as D [T23], [T42]: one row a free particle.
Exact exact_laplacians(const Scene& scene);

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
    explicit Multipliers(const Exact& e, Real zero = 1e-13L);

    /// A frequency of the size of the largest, rad/s.
    double omega() const { return static_cast<double>(omega_); }
    /// √κ, 1/s.
    double growth_rate() const {
        return buckled_ ? static_cast<double>(std::sqrt(-least_) * omega_) : 0;
    }
    bool buckled() const { return buckled_; }
    Index zero_modes() const { return R_.rows() - R_.cols(); }

    RealMatrix step(taut::Method method, double seconds) const;
    ComplexVector operator()(taut::Method method, double h) const;
    /// The largest stable step of explicit Euler: μ = 1 + hλ, so min −2 Re λ/|λ|² [T18].
    double explicit_limit() const;
    /// Whether μ is growth of the physics: real and positive, while K is indefinite [T27].
    bool physical(const std::complex<Real>& mu) const {
        return buckled_ && mu.real() > 0 && std::abs(mu.imag()) < 1e-6L;
    }
    /// The largest modulus but for the physics.
    Real induced_radius(taut::Method method, double h) const;
    Real radius(taut::Method method, double h) const;
    /// How well a multiplier is computed that is not too close to another one.
    static constexpr Real tolerance = 1e6L * real_epsilon;

    // Between the coordinates of step() and metres: x = M^-½ R y/ω, v = M^-½ v̂.
    RealVector position(const RealVector& y) const;
    RealVector velocity(const RealVector& y) const;
    RealVector reduced_position(const RealVector& x) const;

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

/// λ_min of 4M − 2hD − h²K as M⁻¹ of it, over the size of its terms.
Real definite_margin(const Exact& e, double h);

/// The smallest h at which 4M − 2hD − sign·h²K loses definiteness, with 1/h = s: the largest real s
/// of 4s²M − 2sD − sign·K [T19]; infinity if there is none.
double definite_limit(const Exact& e, Real sign, bool project);

}  // namespace taut_test
