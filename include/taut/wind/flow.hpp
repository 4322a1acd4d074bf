// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "../core/buffer.hpp"
#include "../core/types.hpp"

namespace taut {

/// Air that flows past triangles. A triangle has the area A and the unit normal n; u is the air's
/// velocity less the mean of the corners', û = u/|u|, and n is turned so that c = n·û ≥ 0. The
/// force of the air on it is
///
///     ½ ρ |u|² A c (drag û + lift (n − c û)),
///
/// a third on each corner: drag along the flow, lift across it. Edge-on a triangle feels nothing.
/// Seen from the air, drag takes energy and lift does no work. In float, lift is lost where 4A²|u|²
/// is below 1e-38 or above 1e38.
template <class Scalar>
struct Wind {
    Eigen::Matrix<Scalar, 3, 1> velocity = Eigen::Matrix<Scalar, 3, 1>::Zero();  ///< m/s
    std::vector<Triangle> triangles;  ///< either way round; each counts once
    double density = 1.2;             ///< ρ of the air, kg/m³, ≥ 0
    double drag = 1.2;                ///< coefficient, ≥ 0; 1.2 is a plate across the flow
    double lift = 1.2;                ///< coefficient, ≥ 0

    /// Whether there is something for the air to act on.
    bool blows() const { return !triangles.empty() && density > 0 && (drag > 0 || lift > 0); }
};

namespace network_detail {

/// The larger of two numbers; registers have their own.
template <class Real>
Real larger(const Real& a, const Real& b) {
    return a < b ? b : a;
}
/// 1/√a of a normal number.
template <class Real>
Real reciprocal_sqrt(const Real& a) {
    return 1 / std::sqrt(a);
}

/// ρ·drag/108 and ρ·lift/108: with c twice the area times the normal and u three times the relative
/// velocity, ½ is of the formula, ½ of the area, 1/9 of the velocity squared, and ⅓ of the force
/// goes to a corner.
template <class Real>
struct WindFactors {
    Real drag;  // kg/m³
    Real lift;  // kg/m³

    WindFactors() = default;
    template <class Scalar>
    explicit WindFactors(const Wind<Scalar>& wind)
        : drag(static_cast<Real>(wind.density * wind.drag / 108)),
          lift(static_cast<Real>(wind.density * wind.lift / 108)) {}
};

template <class Real>
using Axes = detail::Few<Real, 3>;

template <class Real>
EIGEN_ALWAYS_INLINE Real dot(const Axes<Real>& a, const Axes<Real>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Real>
EIGEN_ALWAYS_INLINE Axes<Real> cross(const Axes<Real>& a, const Axes<Real>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The flow past a triangle. @tparam Real  a number, or a register with a triangle in each lane
template <class Real>
struct Flow {
    Axes<Real> c, u;  // see WindFactors, m² and m/s
    Real cu, u2, c2;  // their products

    Flow() = default;
    /// @param p, q      two sides, m
    /// @param relative  u: three times the air's velocity less the sum of the corners'
    EIGEN_ALWAYS_INLINE Flow(const Axes<Real>& p, const Axes<Real>& q, const Axes<Real>& relative)
        : c(cross(p, q)), u(relative), cu(dot(c, u)), u2(dot(u, u)), c2(dot(c, c)) {}
    /// The force on each corner, N.
    template <class Scalar>
    EIGEN_ALWAYS_INLINE Axes<Real> on_corner(const WindFactors<Scalar>& factors) const {
        const Real s = larger(cu, -cu);
        // Where a triangle or the flow vanishes, so do s and cu, and the forces with them.
        const Real inverse =
            reciprocal_sqrt(larger(c2 * u2, Real((std::numeric_limits<Scalar>::min)())));
        const Real lift = Real(factors.lift) * inverse;
        const Real of_u = (Real(factors.drag) - lift * s) * s;
        const Real of_c = lift * u2 * cu;
        return {of_u * u[0] + of_c * c[0], of_u * u[1] + of_c * c[1], of_u * u[2] + of_c * c[2]};
    }
};

/// The air of a Wind, as a step needs it.
template <class Scalar>
struct Air {
    WindFactors<Scalar> factors;
    Eigen::Matrix<Scalar, 3, 1> three_velocities;  // three times the wind's, m/s

    explicit Air(const Wind<Scalar>& wind)
        : factors(wind), three_velocities(Scalar(3) * wind.velocity) {}
};

/// f ← f + the force of the air on triangles, N, 3 × n.
template <class Scalar>
void add_wind(const Air<Scalar>& air, const std::vector<Triangle>& triangles,
              const Points<Scalar, 3>& x, const Points<Scalar, 3>& v, Points<Scalar, 3>& f) {
    for (const auto& [a, b, c] : triangles) {
        const Eigen::Matrix<Scalar, 3, 1> p = x.col(b) - x.col(a);
        const Eigen::Matrix<Scalar, 3, 1> q = x.col(c) - x.col(a);
        const Eigen::Matrix<Scalar, 3, 1> u =
            air.three_velocities - (v.col(a) + v.col(b) + v.col(c));
        const Flow<Scalar> flow({p[0], p[1], p[2]}, {q[0], q[1], q[2]}, {u[0], u[1], u[2]});
        const Axes<Scalar> on_corner = flow.on_corner(air.factors);
        for (const Index corner : {a, b, c}) {
            for (int d = 0; d < 3; ++d) f(d, corner) += on_corner[d];
        }
    }
}

}  // namespace network_detail
}  // namespace taut
