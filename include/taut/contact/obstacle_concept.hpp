// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "../core/concepts.hpp"

namespace taut {
namespace detail {

template <class Obstacle, class Vector>
using surface_of = decltype(std::declval<const Obstacle&>().surface(std::declval<const Vector&>()));
template <class Surface, class Scalar>
using distance_of = number_of<decltype(std::declval<Surface>().distance), Scalar>;
template <class Surface, class Vector>
using normal_of = number_of<decltype(std::declval<Surface>().normal), Vector>;

/// Whether a shape is convex: unless it says `static constexpr bool convex = false`.
template <class Obstacle>
constexpr bool is_convex() {
    if constexpr (is_detected_v<convex_of, Obstacle>) {
        return Obstacle::convex;
    } else {
        return true;
    }
}

/// What an obstacle has of the Obstacle concept.
template <class Obstacle, class Vector, bool = is_detected_v<surface_of, Obstacle, Vector>>
struct ObstacleHas {
    using Surface = surface_of<Obstacle, Vector>;
    static constexpr bool surface = true;
    static constexpr bool distance = is_detected_v<distance_of, Surface, typename Vector::Scalar>;
    static constexpr bool normal = is_detected_v<normal_of, Surface, Vector>;
    static constexpr bool all = distance && normal;
};
template <class Obstacle, class Vector>
struct ObstacleHas<Obstacle, Vector, false> {
    static constexpr bool surface = false, all = false;
    static constexpr bool distance = true, normal = true;
};

}  // namespace detail

/// The Obstacle concept (docs/concepts.md), for points of the type Vector: one readable sentence
/// for each missing member. Contacts ask it.
template <class Obstacle, class Vector>
constexpr void require_obstacle() {
    using Has = detail::ObstacleHas<Obstacle, Vector>;
    static_assert(Has::surface,
                  "taut::Obstacle: needs `Surface<Scalar, Dim> surface(const Vector& point) "
                  "const` (docs/concepts.md, Obstacle)");
    static_assert(Has::distance,
                  "taut::Obstacle: what surface(point) returns needs `Scalar distance`, m, < 0 "
                  "inside (docs/concepts.md, Obstacle)");
    static_assert(Has::normal,
                  "taut::Obstacle: what surface(point) returns needs `Vector normal`, unit, the "
                  "way out (docs/concepts.md, Obstacle)");
}

}  // namespace taut
