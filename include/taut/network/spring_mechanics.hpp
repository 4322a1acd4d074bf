// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/types.hpp"
#include "damping.hpp"
#include "detail/law_check.hpp"
#include "detail/where_less.hpp"

namespace taut {

/// One spring of a law: what SpringSystem::add_spring takes, and what its visit_springs gives.
template <class Scalar, class Law_>
struct Spring {
    using Law = Law_;

    Index a;
    Index b;
    network_detail::usable_parameters<Law, Scalar> parameters;
    Scalar rest_length;  ///< L, m, ≥ 0
    Scalar damping = 0;  ///< axial, N·s/m, ≥ 0

    /// T(l), N, at the length l > 0, m; positive pulls the ends together.
    Scalar tension(Scalar l) const { return Law::tension(parameters, rest_length, l); }
    /// T′(l), N/m.
    Scalar tension_slope(Scalar l) const { return Law::tension_slope(parameters, rest_length, l); }
    /// The law's bound on T′ and T/l over all lengths, N/m.
    Scalar stiffness_bound() const { return Law::stiffness_bound(parameters, rest_length); }
    /// Energy at the length l, J.
    Scalar energy(Scalar l) const { return Law::energy(parameters, rest_length, l); }
    /// The damper's strength, N·s/m.
    Scalar axial_damping() const { return damping; }
    /// The same spring in another precision.
    template <class Real>
    Spring<Real, Law> cast() const {
        return {a, b, parameters.template cast<Real>(), static_cast<Real>(rest_length),
                static_cast<Real>(damping)};
    }
};

/// A spring's stiffness along or across its axis as K⁺ has it, N/m: 0 where it is negative [T27],
/// [T28]. What is not a number stays so.
template <class Real>
Real k_plus(const Real& stiffness) {
    return stiffness < 0 ? Real(0) : stiffness;
}

/// What one spring adds to K at a pose: H = axial·d dᵀ + transverse·(I − d dᵀ)  [T2].
template <class Scalar, int Dim>
struct SpringTangent {
    Index a;
    Index b;
    Eigen::Matrix<Scalar, Dim, 1> d;  ///< unit vector from a to b; zero when they coincide
    Scalar axial;                     ///< T′(l), N/m
    Scalar transverse;                ///< T(l)/l, N/m; negative in a compressed spring
    Scalar bound;                     ///< the law's bound on both, over all lengths, N/m
    Scalar damping;                   ///< axial, N·s/m

    /// The same spring without negative stiffness: a block of K⁺ [T27], [T28].
    SpringTangent projected() const {
        SpringTangent p = *this;
        p.axial = k_plus(axial);
        p.transverse = k_plus(transverse);
        return p;
    }
};

/// The block axial·d dᵀ + transverse·(I − d dᵀ) of a spring, Dim × Dim, symmetric to the bit [T2].
template <class Vector, class Scalar = typename Vector::Scalar>
auto spring_block(const Vector& d, Scalar axial, Scalar transverse) {
    using Block = Eigen::Matrix<Scalar, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime>;
    Block P = d * d.transpose();  // before the factor, which would round the two triangles apart
    P *= axial - transverse;
    P.diagonal().array() += transverse;
    return P;
}

/// That block times the vector u, which is u_b − u_a of the spring's ends [T2].
template <class Vector, class Scalar = typename Vector::Scalar>
Vector spring_product(const Vector& d, Scalar axial, Scalar transverse, const Vector& u) {
    return transverse * u + (axial - transverse) * d.dot(u) * d;
}

/// A spring's length by its square l², m, but never below √η, with η the least normal number
/// (1.5e-154 m in double, 1.1e-19 m in float): nearer ends coincide, since the squares that the
/// length is made of vanish. Registers have their own (step/spring_table.hpp).
template <class Real>
struct SpringLength {
    Real l;  ///< m

    /// @param l2  dx·dx, m²
    explicit SpringLength(const Real& l2)
        : l(std::sqrt((std::max)(l2, (std::numeric_limits<Real>::min)()))) {}
    /// y/l.
    Real divide(const Real& y) const { return y / l; }
};

/// The length |dx| of a spring with dx = x_b − x_a, m, not below that of SpringLength.
template <class Vector, class Scalar = typename Vector::Scalar>
Scalar spring_length(const Vector& dx) {
    return SpringLength<Scalar>(dx.squaredNorm()).l;
}

/// The force of a spring on its end a, of_dx·dx + of_dv·dv, with dx = x_b − x_a, m, and
/// dv = v_b − v_a, m/s; that on end b is its opposite.
template <class Real>
struct Pull {
    Real of_dx;  ///< N/m
    Real of_dv;  ///< N·s/m
};

/// Adds to a spring's pull that of its damper and of Rayleigh damping αK⁺ [T2], [T28]. Numbers, or
/// registers of as many springs.
/// @param spring  tension_slope(l), stiffness_bound(), axial_damping(): Spring has them
/// @param alpha   α, s; the same for all springs, so that its test costs next to nothing
/// @param l2      dx·dx, m², of `length`   @param over_l  T/l, N/m   @param dx_dv   dx·dv, m²/s
template <class AnySpring, class Scalar, class Real>
EIGEN_ALWAYS_INLINE void add_damping(const AnySpring& spring, Scalar alpha,
                                     const SpringLength<Real>& length, const Real& l2,
                                     const Real& over_l, const Real& dx_dv, Pull<Real>& pull) {
    using network_detail::where_less;
    const Real strain_rate = length.divide(length.divide(dx_dv));  // 1/s
    pull.of_dx += spring.axial_damping() * strain_rate;
    if (alpha > 0) {
        const Real axial = k_plus(spring.tension_slope(length.l));
        const Real transverse =
            where_less(Real(Scalar(0)), l2, k_plus(over_l), Real(spring.stiffness_bound()));
        pull.of_dv += Real(alpha) * transverse;
        pull.of_dx += Real(alpha) * (axial - transverse) * strain_rate;
    }
}

/// The pull of a spring and, if Damped, of its damping: see add_damping.
///
/// Ends that coincide (l² = 0) have no direction: of_dx then stands for nothing and must meet
/// dx = 0, and K⁺ is the law's bound times the identity.
template <bool Damped, class AnySpring, class Scalar, class Real>
EIGEN_ALWAYS_INLINE Pull<Real> pull_coefficients(const AnySpring& spring, Scalar alpha,
                                                 const Real& l2, const Real& dx_dv) {
    const SpringLength<Real> length(l2);
    const Real over_l = length.divide(spring.tension(length.l));
    Pull<Real> pull{over_l, Real(Scalar(0))};
    if constexpr (Damped) add_damping(spring, alpha, length, l2, over_l, dx_dv, pull);
    return pull;
}

/// The force of a spring at rest on its end a, N; the opposite acts on b. @param dx  x_b − x_a, m
template <class Scalar, class Law, class Vector>
EIGEN_ALWAYS_INLINE Vector pull(const Spring<Scalar, Law>& spring, const Vector& dx) {
    const Scalar l2 = dx.squaredNorm();
    if (l2 == 0) return Vector::Zero();
    return pull_coefficients<false>(spring, Scalar(0), l2, Scalar(0)).of_dx * dx;
}

/// The force of a spring and its damper on its end a, N; the opposite acts on b.
/// @param dx  x_b − x_a, m   @param dv  v_b − v_a, m/s
/// @param alpha  of Rayleigh damping, s
template <class Scalar, class Law, class Vector>
Vector pull(const Spring<Scalar, Law>& spring, const Vector& dx, const Vector& dv, Scalar alpha) {
    const Scalar l2 = dx.squaredNorm();
    const Scalar dx_dv = dx.dot(dv);
    const Pull<Scalar> c = alpha > 0 || spring.damping > 0
                               ? pull_coefficients<true>(spring, alpha, l2, dx_dv)
                               : pull_coefficients<false>(spring, alpha, l2, dx_dv);
    Vector force = Vector::Zero();
    if (!(l2 == 0)) force = c.of_dx * dx;  // what is not a number stays so
    if (alpha > 0) force += c.of_dv * dv;
    return force;
}

/// The pull of a spring one step ahead, on its end a: of_dx·y + of_dv·dv − of_here·dx, with
/// y = dx + h·dv.
template <class Real>
struct PullAhead : Pull<Real> {
    Real of_here;  // N/m, ≥ 0
};

namespace network_detail {

/// φ of [T42], N: T(y), and where E(l) lies below the tangent of E at y the least change of it that
/// proves the step.
/// @param of_y  T(y), N   @param y, l  lengths ahead and as it is, m
template <class AnySpring, class Real>
EIGEN_ALWAYS_INLINE Real tension_ahead(const AnySpring& spring, const Real& of_y, const Real& y,
                                       const Real& l) {
    if constexpr (is_monotone_v<typename AnySpring::Law>) {
        return of_y;
    } else {
        const Real zero(0);
        const Real k = spring.stiffness_bound();
        const Real below = k_plus(spring.energy(y) + of_y * (l - y) - spring.energy(l));
        const Real square = Real(0.5) * k * (y - l) * (y - l);
        const Real change = spring.tension(l) + k * (y - l) - of_y;
        const Real not_zero = where_less(zero, below, square + below, Real(1));  // a trap's 0/0
        return where_less(zero, below, of_y + change * (below / not_zero), of_y);
    }
}

}  // namespace network_detail

/// A spring one step ahead pulls along its new direction and pushes along the old one [T42]; it is
/// damped at y. Numbers, or registers.
/// @param y2    y·y, m²   @param y_dv  y·dv, m²/s   @param l2  dx·dx, m²
template <bool Damped, class AnySpring, class Scalar, class Real>
EIGEN_ALWAYS_INLINE PullAhead<Real> pull_ahead_coefficients(const AnySpring& spring, Scalar alpha,
                                                            const Real& y2, const Real& y_dv,
                                                            const Real& l2) {
    const SpringLength<Real> ahead(y2), here(l2);
    const Real of_y = spring.tension(ahead.l);
    const Real tension = network_detail::tension_ahead(spring, of_y, ahead.l, here.l);
    PullAhead<Real> pull;
    pull.of_dx = k_plus(ahead.divide(tension));
    pull.of_dv = Real(Scalar(0));
    pull.of_here = k_plus(here.divide(-tension));
    if constexpr (Damped) {
        add_damping(spring, alpha, ahead, y2, ahead.divide(of_y), y_dv, pull);
    }
    return pull;
}

/// The force of a spring one step ahead and of its damper on its end a, N; the opposite acts on b.
/// @param dx  x_b − x_a, m   @param dv  v_b − v_a, m/s   @param h  of the step, s
/// @param alpha  of Rayleigh damping, s
template <class Scalar, class Law, class Vector>
Vector pull_ahead(const Spring<Scalar, Law>& spring, const Vector& dx, const Vector& dv, Scalar h,
                  Scalar alpha) {
    const Vector y = dx + h * dv;
    if constexpr (Law::convex) {
        return pull(spring, y, dv, alpha);
    } else {
        const auto c = pull_ahead_coefficients<true>(spring, alpha, y.squaredNorm(), y.dot(dv),
                                                     dx.squaredNorm());
        Vector force = c.of_dx * y + c.of_dv * dv;
        if (!(dx.squaredNorm() == 0)) force -= c.of_here * dx;  // what is not a number stays so
        return force;
    }
}

}  // namespace taut
