// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <variant>
#include <taut/contact/obstacle.hpp>

#include "cloth.hpp"

namespace drape {

/// What --collide puts below a scene.
class Obstacle {
public:
    Obstacle(const Options& options, const Cloth& cloth, const State& state);

    /// Puts particles out of it after a step of any method; nothing without --collide.
    void resolve(const Cloth& cloth, State& state) const {
        if (const auto* plane = std::get_if<Plane>(&shape_)) resolve(cloth, *plane, state);
        if (const auto* sphere = std::get_if<Sphere>(&shape_)) resolve(cloth, *sphere, state);
    }
    const std::string& description() const { return description_; }
    explicit operator bool() const { return !std::holds_alternative<std::monostate>(shape_); }

private:
    using Plane = taut::HalfSpace<double, 3>;
    using Sphere = taut::Sphere<double, 3>;

    /// Onto the surface, without the velocity into it; of that along it what Coulomb's law leaves.
    template <class Shape>
    void resolve(const Cloth& cloth, const Shape& shape, State& state) const {
        for (taut::Index i = 0; i < cloth.size(); ++i) {
            if (cloth.is_pinned(i)) continue;
            const auto surface = shape.surface(state.x.col(i));
            if (!(surface.distance <= thickness_)) continue;
            state.x.col(i) += (thickness_ - surface.distance) * surface.normal;
            const double into = -surface.normal.dot(state.v.col(i));
            if (!(into > 0)) continue;
            const Eigen::Vector3d along = state.v.col(i) + into * surface.normal;
            const double speed = along.norm();
            state.v.col(i) = (speed > friction_ * into ? 1 - friction_ * into / speed : 0) * along;
        }
    }

    std::variant<std::monostate, Plane, Sphere> shape_;
    double friction_ = 0, thickness_ = 0;  // Coulomb's; m
    std::string description_;
};

inline Obstacle::Obstacle(const Options& options, const Cloth& cloth, const State& state) {
    if (options.collide.empty()) return;
    const double size = extent(state);
    friction_ = options.friction;
    thickness_ = options.thickness.value_or(0.002 * size);
    const Eigen::Vector3d up = -cloth.gravity().normalized();
    const double lowest = (up.transpose() * state.x).minCoeff();
    const double top = lowest - options.gap.value_or(0.05 * size);
    const Eigen::Vector3d middle =
        (state.x.rowwise().maxCoeff() + state.x.rowwise().minCoeff()) / 2;
    const Eigen::Vector3d below = middle + (top - up.dot(middle)) * up;
    char text[128];
    if (options.collide == "plane") {
        shape_ = Plane(below, up);
        std::snprintf(text, sizeof text, "plane through (%.4g, %.4g, %.4g) m", below[0], below[1],
                      below[2]);
    } else {
        const double radius = options.radius.value_or(0.2 * size);
        const Eigen::Vector3d centre = below - radius * up;
        shape_ = Sphere(centre, radius);
        std::snprintf(text, sizeof text, "sphere of %.4g m at (%.4g, %.4g, %.4g) m", radius,
                      centre[0], centre[1], centre[2]);
    }
    description_ = text;
}

}  // namespace drape
