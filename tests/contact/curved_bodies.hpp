// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/contact/obstacle.hpp>

namespace taut_test {

/// All that is between two spheres about the origin, or with none outside, all but a ball.
template <class Scalar, int Dim>
struct Shell {
    static constexpr bool convex = false;
    Scalar inner, outer;  // m
    taut::Surface<Scalar, Dim> surface(const Eigen::Matrix<Scalar, Dim, 1>& y) const {
        using Vector = Eigen::Matrix<Scalar, Dim, 1>;
        const Scalar length = y.norm();
        const Vector out = length > 0 ? Vector(y / length) : Vector(Vector::Unit(0));
        if (length - outer > inner - length) return {length - outer, out};
        return {inner - length, -out};
    }
};

/// All but a box about the origin.
template <class Scalar, int Dim>
struct Room {
    static constexpr bool convex = false;
    taut::Box<Scalar, Dim> box;
    taut::Surface<Scalar, Dim> surface(const Eigen::Matrix<Scalar, Dim, 1>& y) const {
        const auto found = box.surface(y);
        return {-found.distance, -found.normal};
    }
};

/// All within a radius of a circle about the last axis.
template <class Scalar, int Dim>
struct Torus {
    static constexpr bool convex = false;
    Scalar middle, radius;  // m
    taut::Surface<Scalar, Dim> surface(const Eigen::Matrix<Scalar, Dim, 1>& y) const {
        using Vector = Eigen::Matrix<Scalar, Dim, 1>;
        Vector flat = y;
        flat[Dim - 1] = 0;
        const Scalar length = flat.norm();
        const Vector nearest =
            length > 0 ? Vector(middle / length * flat) : Vector(middle * Vector::Unit(0));
        const Vector out = y - nearest;
        const Scalar away = out.norm();
        return {away - radius, away > 0 ? Vector(out / away) : Vector(Vector::Unit(Dim - 1))};
    }
};

}  // namespace taut_test
