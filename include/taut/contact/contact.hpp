// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once
// Needs the module between.

#include <algorithm>

#include "../between/between_steps.hpp"
#include "../core/detail/fits.hpp"
#include "obstacle.hpp"

namespace taut {
/// How resolve_contacts answers a contact.
struct ContactOptions {
    double friction = 0;   ///< Coulomb's μ, ≥ 0
    double thickness = 0;  ///< kept between particles and the surface, m, ≥ 0
};

/// What resolve_contacts met.
template <class Scalar, int Dim>
struct ContactReport {
    Index contacts = 0;  ///< particles at or below the surface
    Index deepest = -1;  ///< the one that was farthest in, or −1
    Scalar depth = 0;    ///< how far, m
    Eigen::Matrix<Scalar, Dim, 1> impulse =
        Eigen::Matrix<Scalar, Dim,
                      1>::Zero();  ///< Σ m(v⁺ − v), N·s: over h, what the obstacle bears
};

namespace scene_detail {

/// Where a point stands to an obstacle; of one that require_obstacle refuses far outside, so that
/// the compiler has nothing to add to the sentence.
template <class Obstacle, class Vector>
auto surface_at(const Obstacle& obstacle, const Vector& point) {
    if constexpr (detail::ObstacleHas<Obstacle, Vector>::all) {
        return obstacle.surface(point);
    } else {
        return Surface<typename Vector::Scalar, Vector::RowsAtCompileTime>{};
    }
}

/// A State with the members of BetweenSteps.
template <class System>
struct Particles {
    using Vector = Eigen::Matrix<typename System::Scalar, System::Dim, 1>;

    typename System::State& state;

    Vector x(Index i) const { return state.x.col(i); }
    Vector v(Index i) const { return state.v.col(i); }
    void set_x(Index i, const Vector& x) { state.x.col(i) = x; }
    void set_v(Index i, const Vector& v) { state.v.col(i) = v; }
};

/// resolve_contacts of particles as in BetweenSteps.
template <class System, class Obstacle, class Between>
ContactReport<typename System::Scalar, System::Dim> resolve(const System& system,
                                                            const Obstacle& obstacle, Between& now,
                                                            const ContactOptions& options) {
    using Scalar = typename System::Scalar;
    using Vector = Eigen::Matrix<Scalar, System::Dim, 1>;
    require_obstacle<Obstacle, Vector>();
    require_non_negative("resolve_contacts", "friction", options.friction);
    require_non_negative("resolve_contacts", "thickness", options.thickness);
    const auto friction = static_cast<Scalar>(options.friction);
    const auto thickness = static_cast<Scalar>(options.thickness);
    ContactReport<Scalar, System::Dim> report;
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        const Vector x = now.x(i);
        const auto surface = surface_at<Obstacle, Vector>(obstacle, x);
        const Scalar depth = thickness - surface.distance;
        if (!(depth >= 0)) continue;
        ++report.contacts;
        if (report.deepest < 0 || depth > report.depth) {
            report.deepest = i;
            report.depth = depth;
        }
        now.set_x(i, x + depth * surface.normal);
        const Vector v = now.v(i);
        const Scalar into = -surface.normal.dot(v);
        if (!(into > 0)) continue;
        const Vector along = v + into * surface.normal;
        const Scalar speed = along.norm();
        const Scalar kept =
            speed > 0 ? (std::max)(Scalar(0), 1 - friction * into / speed) : Scalar(0);
        now.set_v(i, kept * along);
        report.impulse += system.mass(i) * (kept * along - v);
    }
    return report;
}

}  // namespace scene_detail

/// Puts the free particles of a state out of an obstacle at rest, after each step: a particle below
/// the surface goes to it along the normal n, loses its velocity into the obstacle, v_n = n·v < 0,
/// and of its tangential velocity v_t what Coulomb allows:
///
///     v⁺ = v_t·max(0, 1 − μ|v_n|/|v_t|).
///
/// No particle gains speed. One that starts inside is moved out at once, and without a velocity
/// from it; the springs bear what that stretches. An explicit or one-step method goes on as if
/// nothing had happened; Bdf2 starts anew. Nothing is seen between steps: a step must be short
/// against the obstacle. For several obstacles call it for each; in an acute
/// wedge repeat that until `depth` is small: each round leaves cos² of the angle between them.
/// @param obstacle  `Surface surface(point) const`: HalfSpace, Sphere or your own
/// @throws when friction or thickness is negative or not finite, or the state does not fit
template <class System, class Obstacle>
ContactReport<typename System::Scalar, System::Dim> resolve_contacts(
    const System& system, const Obstacle& obstacle, typename System::State& state,
    const ContactOptions& options = {}) {
    detail::require_fits("resolve_contacts", state, system.size());
    scene_detail::Particles<System> now{state};
    return scene_detail::resolve(system, obstacle, now, options);
}

/// The same between the steps of step_between, where it costs least.
template <class System, class Obstacle>
ContactReport<typename System::Scalar, System::Dim> resolve_contacts(
    const System& system, const Obstacle& obstacle,
    BetweenSteps<typename System::Scalar, System::Dim>& now, const ContactOptions& options = {}) {
    if (now.size() != system.size()) {
        fail("resolve_contacts: ", now.size(), " particles between steps, ", system.size(),
             " in the system");
    }
    return scene_detail::resolve(system, obstacle, now, options);
}

}  // namespace taut
