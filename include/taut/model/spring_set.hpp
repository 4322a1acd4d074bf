// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "../core/types.hpp"
#include "damping.hpp"
#include "detail/law_check.hpp"
#include "detail/slope_range.hpp"

namespace taut {

/// One spring with its rest length given, for SpringSystem::add_spring.
template <class Scalar, class Law>
struct Spring {
    Index a;
    Index b;
    detail::usable_parameters<Law, Scalar> parameters;
    Scalar rest_length;  ///< L, m, ≥ 0
    Scalar damping = 0;  ///< axial, N·s/m, ≥ 0
};

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
        p.axial = axial > 0 ? axial : Scalar(0);
        p.transverse = transverse > 0 ? transverse : Scalar(0);
        return p;
    }
};

/// |dx|, m, but never below √η, with η the least normal number (1.5e-154 m in double, 1.1e-19 m in
/// float): nearer ends coincide, since the squares that the length is made of vanish.
template <class Vector, class Scalar = typename Vector::Scalar>
Scalar spring_length(const Vector& dx) {
    return std::sqrt(std::max(dx.squaredNorm(), std::numeric_limits<Scalar>::min()));
}

/// axial·d dᵀ + transverse·(I − d dᵀ), symmetric to the bit.
template <class Vector, class Scalar = typename Vector::Scalar>
auto spring_block(const Vector& d, Scalar axial, Scalar transverse) {
    using Block = Eigen::Matrix<Scalar, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime>;
    Block P = d * d.transpose();  // before the factor, which would round the two triangles apart
    P *= axial - transverse;
    P.diagonal().array() += transverse;
    return P;
}

/// The springs of one law, which has what require_law asks for: structure of arrays, without
/// damping until a damped one is added.
template <class Scalar, class Law_>
struct SpringSet {
    using Law = Law_;
    using Parameters = typename Law::template Parameters<Scalar>;

    std::vector<int> a;
    std::vector<int> b;
    std::vector<Scalar> rest_length;
    std::vector<Parameters> parameters;
    std::vector<Scalar> damping;  ///< empty until a damped spring is added

    /// The number of springs.
    Index size() const { return static_cast<Index>(a.size()); }
    /// N·s/m.
    Scalar damping_of(std::size_t s) const { return damping.empty() ? Scalar(0) : damping[s]; }

    /// Appends a spring whose values SpringSystem has checked.
    void add(const Spring<Scalar, Law>& spring) {
        if (spring.damping > 0 && damping.empty()) damping.assign(a.size(), Scalar(0));
        a.push_back(static_cast<int>(spring.a));
        b.push_back(static_cast<int>(spring.b));
        rest_length.push_back(spring.rest_length);
        parameters.push_back(spring.parameters);
        if (spring.damping > 0 || !damping.empty()) damping.push_back(spring.damping);
    }

    /// The last spring takes the index of spring s.
    void remove(std::size_t s) {
        move(a.size() - 1, s);
        shrink(a.size() - 1);
    }
    /// Removes the springs s with goes(s), asked in their order; the others keep theirs.
    /// @returns how many went
    template <class Predicate>
    Index remove_if(Predicate&& goes) {
        const std::size_t count = a.size();
        std::size_t kept = 0;
        for (std::size_t s = 0; s < count; ++s) {
            if (!goes(static_cast<Index>(s))) move(s, kept++);
        }
        shrink(kept);
        return static_cast<Index>(count - kept);
    }

    /// The tangent of spring s with its ends at x, in the precision of x. Where the ends coincide
    /// for Scalar (spring_length), and where l overflows, it is the law's bound times the identity:
    /// no tangent is larger.
    template <class Real, int Dim>
    SpringTangent<Real, Dim> tangent(std::size_t s, const Points<Real, Dim>& x) const {
        SpringTangent<Real, Dim> t;
        t.a = a[s];
        t.b = b[s];
        const auto p = parameters[s].template cast<Real>();
        const Real L = static_cast<Real>(rest_length[s]);
        t.bound = Law::stiffness_bound(p, L);
        t.damping = static_cast<Real>(damping_of(s));
        t.d = x.col(t.b) - x.col(t.a);
        const Real l2 = t.d.squaredNorm();
        if (l2 >= static_cast<Real>(std::numeric_limits<Scalar>::min()) && std::isfinite(l2)) {
            const Real l = std::sqrt(l2);
            t.d /= l;
            t.axial = Law::tension_slope(p, L, l);
            t.transverse = Law::tension(p, L, l) / l;
        } else {
            t.d.setZero();
            t.axial = t.transverse = t.bound;
        }
        return t;
    }

    /// The force of spring s on its end a, N; the opposite acts on b.
    /// @param dx  x_b − x_a, m   @param dv  v_b − v_a, m/s
    /// @param by  damping in proportion to stiffness, where Proportional
    template <bool Dampers, bool Proportional, class Vector>
    Vector pull(std::size_t s, const Vector& dx, const Vector& dv,
                const StiffnessDamping<Scalar>& by) const {
        Vector pull = Vector::Zero();
        Scalar bound = 0;
        if constexpr (Proportional) {
            bound = Law::stiffness_bound(parameters[s], rest_length[s]);
            pull = by.graph * bound * dv;
        }
        if (dx.squaredNorm() > 0) {
            const Scalar l = spring_length(dx);
            const Scalar over_l = Law::tension(parameters[s], rest_length[s], l) / l;
            pull += over_l * dx;
            if constexpr (Dampers || Proportional) {
                const Vector d = dx / l;
                const Scalar stretching = d.dot(dv);
                if constexpr (Dampers) pull += damping[s] * stretching * d;
                if constexpr (Proportional) {
                    const Scalar slope = Law::tension_slope(parameters[s], rest_length[s], l);
                    const Scalar axial = slope > 0 ? slope : Scalar(0);
                    const Scalar transverse = over_l > 0 ? over_l : Scalar(0);
                    pull +=
                        by.projected * (transverse * dv + (axial - transverse) * stretching * d);
                }
            }
        } else {
            pull += by.projected * bound * dv;
        }
        return pull;
    }

    /// The power that damping takes from spring s, W, by the factors of its sum.
    struct Braking {
        double damper = 0;     ///< of its own damper, W
        double projected = 0;  ///< dvᵀH⁺dv with H⁺ its block of K⁺, W/s
        double graph = 0;      ///< dvᵀdv times the law's bound, W/s

        /// In proportion to stiffness, W.
        double of(const StiffnessDamping<double>& by) const {
            return by.projected * projected + by.graph * graph;
        }
    };
    /// @param dx  x_b − x_a, m   @param dv  v_b − v_a, m/s   @param l  spring_length(dx)
    /// @param over_l  T/l, N/m
    template <class Vector>
    Braking braking(std::size_t s, const Vector& dx, const Vector& dv, Scalar l,
                    Scalar over_l) const {
        Braking power;
        const auto dv2 = static_cast<double>(dv.squaredNorm());
        power.graph =
            static_cast<double>(Law::stiffness_bound(parameters[s], rest_length[s])) * dv2;
        power.projected = power.graph;
        if (!(dx.squaredNorm() > 0)) return power;
        const auto stretching = static_cast<double>(dx.dot(dv) / l);
        const double along = stretching * stretching;
        const auto slope =
            static_cast<double>(Law::tension_slope(parameters[s], rest_length[s], l));
        power.damper = static_cast<double>(damping_of(s)) * along;
        power.projected = std::max(0.0, slope) * along +
                          std::max(0.0, static_cast<double>(over_l)) * (dv2 - along);
        return power;
    }

    /// The least and the largest T′ of spring s about its length at x, N/m: those of both sides
    /// where the rounding of positions and rest length to Scalar may take it across a kink.
    /// @param t  the spring's tangent at x
    template <class Real, int Dim>
    std::pair<Real, Real> axial_range(std::size_t s, const Points<Real, Dim>& x,
                                      const SpringTangent<Real, Dim>& t) const {
        if (t.d.isZero(0)) return {t.axial, t.axial};
        const auto p = parameters[s].template cast<Real>();
        const Real L = static_cast<Real>(rest_length[s]);
        const Real l = (x.col(t.b) - x.col(t.a)).norm();
        const Real size = x.col(t.a).cwiseAbs().maxCoeff() + x.col(t.b).cwiseAbs().maxCoeff() + L;
        const Real reach = 8 * static_cast<Real>(std::numeric_limits<Scalar>::epsilon()) * size;
        if (!std::isfinite(l + reach)) return {t.axial, t.axial};
        // Laws are asked for l > 0: below this length the ends coincide [T3].
        const Real shortest = std::sqrt(static_cast<Real>(std::numeric_limits<Scalar>::min()));
        const auto [least, most] =
            detail::slope_range<Law>(p, L, std::max(l - reach, shortest), l + reach);
        return {std::min(least, t.axial), std::max(most, t.axial)};
    }

private:
    void move(std::size_t from, std::size_t to) {
        if (from == to) return;
        a[to] = a[from];
        b[to] = b[from];
        rest_length[to] = rest_length[from];
        parameters[to] = parameters[from];
        if (!damping.empty()) damping[to] = damping[from];
    }
    void shrink(std::size_t count) {
        a.resize(count);
        b.resize(count);
        rest_length.resize(count);
        parameters.erase(parameters.begin() + static_cast<std::ptrdiff_t>(count), parameters.end());
        if (!damping.empty()) damping.resize(count);
    }
};

namespace detail {

/// Where a system keeps the springs of a law.
template <class Scalar, class Law>
using SetOf = SpringSet<Scalar, usable_law<Law, Scalar>>;

}  // namespace detail
}  // namespace taut
