// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "../../step/layout.hpp"
#include "../pose.hpp"

namespace taut::contact_detail {

/// A body's rigid motion in a step.
template <class Scalar, int Dim>
struct Motion {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Rotation = Eigen::Matrix<Scalar, Dim, Dim>;

    Pose<Scalar, Dim> now, next;
    Rotation turn = Rotation::Identity();  // of normals
    Vector shift = Vector::Zero();         // a point x at rest in the body goes to turn·x + shift

    void go_to(const Pose<Scalar, Dim>& pose) {
        now = next;
        next = pose;
        turn = next.rotation * now.rotation.transpose();
        shift = next.position - turn * now.position;
    }
};

/// What the contacts of a scene have in common.
template <class Scalar>
struct Penalty {
    Scalar h;        // s
    Scalar by_mass;  // κ/m, 1/s²

    /// ½h²κ/m.
    Scalar block() const { return h * h * by_mass / 2; }
    /// φ(p), J. @param depth  p   @param cap  p₁, m
    double energy(Scalar depth, Scalar cap, Scalar mass) const {
        return static_cast<double>(mass) * energy_by_mass(static_cast<double>(depth), cap);
    }
    double energy_by_mass(double p, Scalar cap) const {
        if (!(p > 0)) return 0;
        const auto k = static_cast<double>(by_mass), most = static_cast<double>(cap);
        return p <= most ? k * p * p / 2 : k * most * (p - most / 2);
    }
};

/// The speed out of a body with contact, m/s, from what it is at no depth, and what all of φ′ adds.
/// As much of φ′ acts as brings what goes in to rest, but at least half of it where it goes out:
/// what rests stays at rest under a kick and half a kick, the first one of a frame.
template <class Scalar, int most>
EIGEN_ALWAYS_INLINE step_detail::VectorRegister<Scalar, most> rest(
    const step_detail::VectorRegister<Scalar, most>& in,
    const step_detail::VectorRegister<Scalar, most>& push) {
    using Register = step_detail::VectorRegister<Scalar, most>;
    const Register zero(Scalar(0)), all = in + push, half = in + Register(Scalar(0.5)) * push;
    return where_less(zero, half, half, where_less(zero, all, zero, all));
}

/// Vectors by place, one or a register of them.
template <class Scalar, int Dim>
class PlaneAccess {
public:
    using Register = step_detail::VectorRegister<Scalar>;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    PlaneAccess(const step_detail::Layout<Scalar>& layout,
                const step_detail::Planes<Scalar>& planes)
        : first_(planes.first),
          axis_(layout.has_stars() ? 1 : planes.stride),
          grain_(layout.grain()) {}
    /// Planes side by side. @param axis  from one plane to the next
    PlaneAccess(Scalar* first, Index axis) : first_(first), axis_(axis), grain_(1) {}

    Scalar& operator()(int d, Index place) const { return first_[d * axis_ + place * grain_]; }
    Vector vector(Index place) const {
        Vector result;
        for (int d = 0; d < Dim; ++d) result[d] = (*this)(d, place);
        return result;
    }
    void set(Index place, const Vector& to) const {
        for (int d = 0; d < Dim; ++d) (*this)(d, place) = to[d];
    }
    /// Those from a place on.
    EIGEN_ALWAYS_INLINE Register row(int d, Index place) const {
        if (grain_ == 1) return Register::load(first_ + d * axis_ + place);
        detail::Few<Scalar, Register::width> lanes;
        for (int k = 0; k < Register::width; ++k) lanes[k] = (*this)(d, place + k);
        return Register::load(lanes.data());
    }
    /// Copies those at `count` places to planes side by side.
    void gather(const int* places, Index count, const PlaneAccess& to) const {
        for (int d = 0; d < Dim; ++d) {
            const Scalar* from = first_ + d * axis_;
            Scalar* row = to.first_ + d * to.axis_;
            if (grain_ == 1) {
                for (Index k = 0; k < count; ++k) row[k] = from[places[k]];
            } else {
                for (Index k = 0; k < count; ++k) row[k] = from[places[k] * grain_];
            }
        }
    }

private:
    Scalar* first_;
    Index axis_, grain_;
};

/// As many as fill whole registers.
template <class Scalar>
constexpr Index whole_registers(Index count) {
    constexpr Index width = step_detail::VectorRegister<Scalar>::width;
    return (count + width - 1) / width * width;
}

/// The largest lane.
template <class Scalar, int most>
EIGEN_ALWAYS_INLINE Scalar largest_lane(const step_detail::VectorRegister<Scalar, most>& a) {
    return Eigen::internal::predux_max(a.packet);
}

/// M y of vectors, a lane each.
template <class Matrix, class Real, int Dim>
EIGEN_ALWAYS_INLINE detail::Few<Real, Dim> times(const Matrix& M, const detail::Few<Real, Dim>& y) {
    detail::Few<Real, Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = Real(M(d, 0)) * y[0];
        for (int e = 1; e < Dim; ++e) result[d] += Real(M(d, e)) * y[e];
    }
    return result;
}
template <class Real, int Dim>
EIGEN_ALWAYS_INLINE Real dot(const detail::Few<Real, Dim>& a, const detail::Few<Real, Dim>& b) {
    Real sum = a[0] * b[0];
    for (int d = 1; d < Dim; ++d) sum += a[d] * b[d];
    return sum;
}

}  // namespace taut::contact_detail
