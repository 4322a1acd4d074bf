// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <map>

#include "../core/error.hpp"
#include "../core/types.hpp"

namespace taut {

/// Velocities that single particles must have along single directions: Nᵀv = s, N orthonormal. The
/// constraints of D. Baraff, A. Witkin, "Large steps in cloth simulation", SIGGRAPH 1998, section
/// 5: a particle held in a plane, on a line, at a point, or moved.
///
/// Constraints on one particle add up: two planes make a line, three a point. One that contradicts
/// those before it is refused, and names the particle; directions closer than 1e-4 rad count as
/// one.
template <class Scalar, int Dim>
class ParticleConstraints {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Block = Eigen::Matrix<Scalar, Dim, Dim>;

    /// The constrained directions of a particle, and its speeds along them.
    struct Held {
        int count = 0;
        Block directions = Block::Zero();  ///< its first `count` columns are orthonormal
        Vector speeds = Vector::Zero();    ///< m/s

        /// S = I − NNᵀ: what is left free.
        Block free() const { return Block::Identity() - directions * directions.transpose(); }
        /// N s, m/s.
        Vector velocity() const { return directions * speeds; }
    };

    /// v·direction = speed, m/s. What contradicts earlier constraints goes to fail(), and then
    /// nothing has changed; so with the functions below. @param direction  of any length but 0
    void hold(Index particle, const Vector& direction, Scalar speed = 0) {
        Held at = of(particle);
        add(at, particle, direction, speed);
        held_[particle] = at;
    }
    /// In the plane across `normal`, which itself moves along it with `speed`, m/s.
    void hold_in_plane(Index particle, const Vector& normal, Scalar speed = 0) {
        hold(particle, normal, speed);
    }
    /// On the line along `direction`.
    void hold_on_line(Index particle, const Vector& direction);
    /// In all directions: v = velocity, m/s.
    void prescribe(Index particle, const Vector& velocity) {
        Held at = of(particle);
        for (int d = 0; d < Dim; ++d) add(at, particle, Vector::Unit(d), velocity[d]);
        held_[particle] = at;
    }
    /// At rest, in all directions.
    void fix(Index particle) { prescribe(particle, Vector::Zero()); }
    /// Drops all constraints of a particle; one that has none is no error.
    void release(Index particle) { held_.erase(particle); }
    /// Drops all constraints.
    void clear() { held_.clear(); }

    /// The constrained particles by index.
    const std::map<Index, Held>& held() const { return held_; }

    /// Takes the constrained part out of a vector for each particle, Dim × n: the filter of their
    /// conjugate gradients.
    void filter(Points<Scalar, Dim>& values) const {
        for (const auto& [particle, at] : held_) {
            values.col(particle) = (at.free() * values.col(particle)).eval();
        }
    }

private:
    Held of(Index particle) const {
        const auto found = held_.find(particle);
        return found == held_.end() ? Held{} : found->second;
    }
    static void add(Held& at, Index particle, const Vector& direction, Scalar speed);

    std::map<Index, Held> held_;
};

template <class Scalar, int Dim>
void ParticleConstraints<Scalar, Dim>::add(Held& at, Index particle, const Vector& direction,
                                           Scalar speed) {
    if (particle < 0) fail("ParticleConstraints: particle is ", particle, "; it must be >= 0");
    if (!detail::all_finite(direction) || !(direction.stableNorm() > 0) ||
        !detail::is_finite(speed)) {
        fail("ParticleConstraints: particle ", particle,
             ": the direction must be finite and not zero, and the speed finite; it is ", speed);
    }
    const Vector n = direction.stableNormalized();
    const Vector known = at.directions.transpose() * n;
    Vector rest = n - at.directions * known;
    const Scalar size = rest.norm();
    const Scalar implied = known.dot(at.speeds);
    // Nearer directions count as one: the speed implied across them would be 10⁴ times as large.
    constexpr Scalar parallel = static_cast<Scalar>(1e-4);
    if (size <= parallel) {
        const Scalar known_speed = at.speeds.cwiseAbs().maxCoeff();
        const Scalar rounding =
            64 * std::numeric_limits<Scalar>::epsilon() * ((std::abs)(speed) + known_speed);
        if ((std::abs)(speed - implied) > rounding + 2 * size * known_speed) {
            fail("ParticleConstraints: particle ", particle, " is held to a speed of ", implied,
                 " along this direction; ", speed, " contradicts it");
        }
        return;
    }
    rest /= size;
    rest = (rest - at.directions * (at.directions.transpose() * rest)).normalized();
    at.directions.col(at.count) = rest;
    at.speeds[at.count] = (speed - implied) / size;
    ++at.count;
}

template <class Scalar, int Dim>
void ParticleConstraints<Scalar, Dim>::hold_on_line(Index particle, const Vector& direction) {
    // All axes but the most aligned one, less their part along the line, span its complement.
    if (!detail::all_finite(direction) || !(direction.stableNorm() > 0)) {
        fail("ParticleConstraints: particle ", particle,
             ": the direction of a line must be finite and not zero");
    }
    const Vector d = direction.stableNormalized();
    Index along = 0;
    d.cwiseAbs().maxCoeff(&along);
    Held at = of(particle);
    for (int axis = 0; axis < Dim; ++axis) {
        if (axis == along) continue;
        const Vector across = Vector::Unit(axis) - d[axis] * d;
        add(at, particle, across, 0);
    }
    held_[particle] = at;
}

}  // namespace taut
