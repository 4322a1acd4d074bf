// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include "../core/error.hpp"
#include "../network/spring_system.hpp"
#include "wind_force.hpp"

namespace taut {

/// Sets the wind on a system in three dimensions, in place of the last one. One that has no
/// triangles, density or coefficient ends it. Copies of the system have it, too. Values out of
/// range go to fail(), by name.
template <class Scalar, class... Laws>
void set_wind(SpringSystem<Scalar, 3, Laws...>& system, Wind<Scalar> wind) {
    if (!detail::all_finite(wind.velocity)) fail("set_wind: velocity is not finite");
    require_held<Scalar>("set_wind", "density", wind.density);
    require_held<Scalar>("set_wind", "drag", wind.drag);
    require_held<Scalar>("set_wind", "lift", wind.lift);
    require_held<Scalar>("set_wind", "density * drag", wind.density * wind.drag);
    require_held<Scalar>("set_wind", "density * lift", wind.density * wind.lift);
    for (const auto& triangle : wind.triangles) {
        for (const Index corner : triangle) {
            if (corner >= 0 && corner < system.size()) continue;
            fail("set_wind: a corner is ", corner, "; there are ", system.size(), " particles");
        }
    }
    if (!wind.blows()) return system.set_outside_force(nullptr);
    auto triangles = std::make_shared<const std::vector<Triangle>>(std::move(wind.triangles));
    system.set_outside_force(
        std::make_shared<network_detail::WindForce<Scalar>>(wind, std::move(triangles)));
}

/// Changes the velocity of the wind that there is, as in a gust; no plan is made anew.
/// @param velocity  m/s, finite
template <class Scalar, class... Laws>
void set_wind_velocity(SpringSystem<Scalar, 3, Laws...>& system,
                       const typename SpringSystem<Scalar, 3, Laws...>::Vector& velocity) {
    if (!detail::all_finite(velocity)) fail("set_wind_velocity: velocity is not finite");
    using Force = network_detail::WindForce<Scalar>;
    const Force* const wind = Force::of(system.external_forces().outside.get());
    if (wind) system.set_outside_force(std::make_shared<Force>(*wind, velocity));
}

}  // namespace taut
