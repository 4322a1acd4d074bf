// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <utility>

#include "../core/revision.hpp"
#include "particle_force.hpp"
#include "state.hpp"
#include "../wind/wind.hpp"

namespace taut {

/// What acts on the particles of a SpringSystem beside springs and gravity.
template <class Scalar, int Dim>
struct ExternalForces {
    /// See SpringSystem::ExternalForce.
    std::function<void(const State<Scalar, Dim>&, Points<Scalar, Dim>&)> whole;
    model_detail::ParticleForce<Scalar, Dim> by_particle;
    Points<Scalar, Dim> constant;  ///< N, Dim × n, or 0 columns for none
    Index constants = 0;           ///< those that are not 0
    Wind<Scalar> wind;
    Revision triangles;  ///< of the wind

    /// Whether there is any.
    bool any() const { return whole || by_particle || constant.cols() > 0 || wind.blows(); }
    /// f ← f + all of them at a state, N, Dim × n.
    void add(const State<Scalar, Dim>& state, Points<Scalar, Dim>& f) const {
        if (constant.cols() > 0) f.leftCols(constant.cols()) += constant;
        if constexpr (Dim == 3) {
            if (wind.blows()) model_detail::add_wind(wind, state.x, state.v, f);
        }
        if (by_particle) {
            by_particle(
                {state.x.data(), state.v.data(), f.data(), 1, 1, Dim, state.x.cols(), 0, nullptr});
        }
        if (whole) whole(state, f);
    }
};

}  // namespace taut
