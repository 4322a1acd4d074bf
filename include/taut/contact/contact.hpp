// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "../core/concepts.hpp"
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

/// Moves each free particle that is too deep out along the normal; its velocity stays.
/// @param visit  visit(i, normal) for each of them
template <class System, class Obstacle, class Visitor>
ContactReport<typename System::Scalar, System::Dim> lift_out(const System& system,
                                                             const Obstacle& obstacle,
                                                             typename System::State& state,
                                                             const ContactOptions& options,
                                                             Visitor&& visit) {
    using Scalar = typename System::Scalar;
    using Vector = Eigen::Matrix<Scalar, System::Dim, 1>;
    require_obstacle<Obstacle, Vector>();
    require_non_negative("resolve_contacts", "friction", options.friction);
    require_non_negative("resolve_contacts", "thickness", options.thickness);
    detail::require_fits("resolve_contacts", state, system.size());
    const auto thickness = static_cast<Scalar>(options.thickness);
    ContactReport<Scalar, System::Dim> report;
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        const auto surface = surface_at<Obstacle, Vector>(obstacle, state.x.col(i));
        const Scalar depth = thickness - surface.distance;
        if (!(depth >= 0)) continue;
        ++report.contacts;
        if (report.deepest < 0 || depth > report.depth) {
            report.deepest = i;
            report.depth = depth;
        }
        state.x.col(i) += depth * surface.normal;
        visit(i, surface.normal);
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
    using Scalar = typename System::Scalar;
    using Vector = Eigen::Matrix<Scalar, System::Dim, 1>;
    const auto friction = static_cast<Scalar>(options.friction);
    Vector impulse = Vector::Zero();
    auto report = scene_detail::lift_out(
        system, obstacle, state, options, [&](Index i, const Vector& normal) {
            const Scalar into = -normal.dot(state.v.col(i));
            if (!(into > 0)) return;
            const Vector before = state.v.col(i);
            const Vector along = before + into * normal;
            const Scalar speed = along.norm();
            const Scalar kept =
                speed > 0 ? (std::max)(Scalar(0), 1 - friction * into / speed) : Scalar(0);
            state.v.col(i) = kept * along;
            impulse += system.mass(i) * (state.v.col(i) - before);
        });
    report.impulse = impulse;
    return report;
}

}  // namespace taut
