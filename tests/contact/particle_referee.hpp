// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "../support/random.hpp"

namespace taut_test {

using Real = long double;
using Wide = Eigen::Matrix<Real, 3, 1>;  // in three dimensions whatever the particle has

/// What the theorem says of one pair in a step.
struct PairReferee {
    Real unit;                 // of rounding
    Real h, k, block;          // κ/m, ½h²κ/m
    Real begin, cap;           // p, p₁
    Real friction, push_out;   // μ; m/s
    Wide normal, speed;        // n′, ū
    Real reach;                // m, by which places are rounded
    bool carries;              // whether the body carries x and n as its motion says
    Wide at;                   // the body at the end
    Real thickness, radius;    // of a ball, or 0
    std::vector<Wide> planes;  // their normals at the end
    std::vector<Real> offsets;

    /// p at the end of the step, m.
    Real depth(const Wide& x) const {
        if (radius > 0) return thickness + radius - (x - at).norm();
        Real most = -std::numeric_limits<Real>::infinity();
        for (std::size_t i = 0; i < planes.size(); ++i)
            most = (std::max)(most, planes[i].dot(x - at) - offsets[i]);
        return thickness - most;
    }
    /// h n′·(v − ū)/h, m/s: how fast it goes out.
    Real out(const Wide& v) const { return normal.dot(v - speed); }
    Wide along(const Wide& v) const { return v - speed - out(v) * normal; }
    /// φ/m of a depth.
    Real energy(Real p) const {
        if (!(p > 0)) return 0;
        return p < cap ? k * p * p / 2 : k * cap * (p - cap / 2);
    }
    /// Whether it began inside and is to be pushed out at a stated speed, without friction.
    bool gently() const { return cap < std::numeric_limits<Real>::infinity(); }
    /// hφ′/m of a depth, m/s.
    Real kick(Real p) const { return h * k * (std::max)((std::min)(p, cap), Real(0)); }
};

/// A step as it was solved.
struct Step {
    std::vector<PairReferee> pairs;
    Wide x, before, after;  // where it begins, m; speeds without contact and with it, m/s
    Real work = 0;          // Σ h ū·f/m
    bool touches = false;
    bool in_registers = false;  // ū has been computed there, and what begins inside is braked
    bool follows = false;       // whether the new place is that of the new speed

    Wide end() const { return x + pairs[0].h * after; }
    /// What speeds are rounded by, m/s.
    Real size() const {
        Real sum = before.norm() + after.norm();
        for (const auto& pair : pairs) sum += pair.speed.norm();
        if (in_registers) sum += pairs[0].reach / pairs[0].h;
        return sum;
    }
    /// By how much the stiffest of several pairs magnifies what is rounded.
    Real magnified() const {
        if (pairs.size() == 1) return 1;
        bool rubs = false;
        for (const auto& pair : pairs) rubs = rubs || pair.friction > 0;
        return 1 + static_cast<Real>(pairs.size()) * pairs[0].block +
               (rubs ? 1 / std::sqrt(pairs[0].unit) : Real(0));
    }
};

/// What particles are drawn.
struct ParticleOptions {
    bool stiff = false;  ///< ½h²κ/m up to all that Contacts takes, else up to 100
    bool flush = false;  ///< all planes are one plane, move as one and have no friction
    Index bodies = 1;
};

/// A particle drawn at random between bodies, and what contact makes of it; once more with the
/// bodies in another order.
template <class Scalar, int Dim>
std::array<Step, 2> solved_steps(Random& random, const ParticleOptions& options);

/// A register of particles before one body as push() leaves them, and the same by ParticleSolve.
template <class Scalar, int Dim>
std::vector<std::array<Step, 2>> pushed_steps(Random& random, bool stiff);

}  // namespace taut_test
