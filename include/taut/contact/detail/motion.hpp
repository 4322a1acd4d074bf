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
    Scalar ahead;    // s, by which springs see x ahead

    /// ½h²κ/m.
    Scalar block() const { return h * h * by_mass / 2; }
    /// φ(p), J. @param depth  p   @param cap  p₁, m
    double energy(Scalar depth, Scalar cap, Scalar mass) const {
        if (!(depth > 0)) return 0;
        const double k = static_cast<double>(by_mass) * static_cast<double>(mass);
        const auto p = static_cast<double>(depth), most = static_cast<double>(cap);
        return p <= most ? k * p * p / 2 : k * most * (p - most / 2);
    }
};

/// Vectors by place, one or a register of them.
template <class Scalar, int Dim>
class PlaneAccess {
public:
    using Register = step_detail::VectorRegister<Scalar>;
    template <class Real>
    using Vectors = detail::Few<Real, Dim>;

    PlaneAccess(const step_detail::Layout<Scalar>& layout,
                const step_detail::Planes<Scalar>& planes)
        : first_(planes.first),
          axis_(layout.has_stars() ? 1 : planes.stride),
          grain_(layout.grain()) {}
    /// Planes side by side. @param axis  from one plane to the next
    PlaneAccess(Scalar* first, Index axis) : first_(first), axis_(axis), grain_(1) {}

    Scalar& operator()(int d, Index place) const { return first_[d * axis_ + place * grain_]; }
    Eigen::Matrix<Scalar, Dim, 1> vector(Index place) const {
        Eigen::Matrix<Scalar, Dim, 1> result;
        for (int d = 0; d < Dim; ++d) result[d] = (*this)(d, place);
        return result;
    }
    void set(Index place, const Eigen::Matrix<Scalar, Dim, 1>& to) const {
        for (int d = 0; d < Dim; ++d) (*this)(d, place) = to[d];
    }
    /// Those from a place on.
    EIGEN_ALWAYS_INLINE Register row(int d, Index place) const {
        if (grain_ == 1) return Register::load(first_ + d * axis_ + place);
        detail::Few<Scalar, Register::width> lanes;
        for (int k = 0; k < Register::width; ++k) lanes[k] = (*this)(d, place + k);
        return Register::load(lanes.data());
    }
    EIGEN_ALWAYS_INLINE void set_row(int d, Index place, const Register& to) const {
        if (grain_ == 1) return to.store(first_ + d * axis_ + place);
        detail::Few<Scalar, Register::width> lanes;
        to.store(lanes.data());
        for (int k = 0; k < Register::width; ++k) (*this)(d, place + k) = lanes[k];
    }

private:
    Scalar* first_;
    Index axis_, grain_;
};

/// The largest lane.
template <class Scalar, int most>
EIGEN_ALWAYS_INLINE Scalar largest_lane(const step_detail::VectorRegister<Scalar, most>& a) {
    return Eigen::internal::predux_max(a.packet);
}

template <class Scalar, int most>
EIGEN_ALWAYS_INLINE Scalar sum_of_lanes(const step_detail::VectorRegister<Scalar, most>& a) {
    return Eigen::internal::predux(a.packet);
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
