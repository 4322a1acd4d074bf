// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "../core/buffer.hpp"
#include "../core/types.hpp"
#include "detail/slope_range.hpp"
#include "spring_mechanics.hpp"

namespace taut {

namespace network_detail {

template <class Set>
struct SpringIterator {
    const Set* set;
    std::size_t s;

    auto operator*() const { return (*set)[s]; }
    SpringIterator& operator++() {
        ++s;
        return *this;
    }
    bool operator!=(const SpringIterator& other) const { return s != other.s; }
};

}  // namespace network_detail

/// The springs of one law, which has what require_law asks for: structure of arrays, without
/// damping until a damped one is added.
template <class Scalar, class Law_>
struct SpringSet {
    using Law = Law_;
    using Parameters = typename Law::template Parameters<Scalar>;

    Buffer<int> a;
    Buffer<int> b;
    Buffer<Scalar> rest_length;
    std::conditional_t<std::is_trivially_copyable_v<Parameters>, Buffer<Parameters>,
                       std::vector<Parameters>>
        parameters;
    Buffer<Scalar> damping;  ///< empty until a damped spring is added

    /// The number of springs.
    Index size() const { return static_cast<Index>(a.size()); }
    /// N·s/m.
    Scalar damping_of(std::size_t s) const { return damping.empty() ? Scalar(0) : damping[s]; }
    /// Spring s.
    Spring<Scalar, Law> operator[](std::size_t s) const {
        return {a[s], b[s], parameters[s], rest_length[s], damping_of(s)};
    }
    /// The Spring of each in turn, in the order of their indices: `for (const auto spring : set)`.
    auto begin() const { return network_detail::SpringIterator<SpringSet>{this, 0}; }
    /// Where that ends.
    auto end() const { return network_detail::SpringIterator<SpringSet>{this, a.size()}; }

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
        const auto spring = (*this)[s].template cast<Real>();
        SpringTangent<Real, Dim> t;
        t.a = spring.a;
        t.b = spring.b;
        t.bound = spring.stiffness_bound();
        t.damping = spring.damping;
        for (int k = 0; k < Dim; ++k) t.d[k] = x(k, t.b) - x(k, t.a);
        const Real l2 = t.d.squaredNorm();
        if (l2 >= static_cast<Real>((std::numeric_limits<Scalar>::min)()) &&
            detail::is_finite(l2)) {
            const Real l = std::sqrt(l2);
            for (int k = 0; k < Dim; ++k) t.d[k] /= l;
            t.axial = spring.tension_slope(l);
            t.transverse = spring.tension(l) / l;
        } else {
            for (int k = 0; k < Dim; ++k) t.d[k] = 0;
            t.axial = t.transverse = t.bound;
        }
        return t;
    }

    /// The least and the largest T′ of spring s about its length at x, N/m: those of both sides
    /// where the rounding of positions and rest length to Scalar may take it across a kink.
    /// @param t  the spring's tangent at x
    template <class Real, int Dim>
    std::pair<Real, Real> axial_range(std::size_t s, const Points<Real, Dim>& x,
                                      const SpringTangent<Real, Dim>& t) const {
        Eigen::Matrix<Real, Dim, 1> dx;
        Real far_a = 0, far_b = 0;
        bool apart = false;
        for (int k = 0; k < Dim; ++k) {
            dx[k] = x(k, t.b) - x(k, t.a);
            far_a = (std::max)(far_a, (std::abs)(x(k, t.a)));
            far_b = (std::max)(far_b, (std::abs)(x(k, t.b)));
            apart = apart || t.d[k] != 0;
        }
        if (!apart) return {t.axial, t.axial};
        const auto p = parameters[s].template cast<Real>();
        const Real L = static_cast<Real>(rest_length[s]);
        const Real l = std::sqrt(dx.squaredNorm());
        const Real size = far_a + far_b + L;
        const Real reach = 8 * static_cast<Real>(std::numeric_limits<Scalar>::epsilon()) * size;
        if (!detail::is_finite(l + reach)) return {t.axial, t.axial};
        // Laws are asked for l > 0: below this length the ends coincide [T3].
        const Real shortest = std::sqrt(static_cast<Real>((std::numeric_limits<Scalar>::min)()));
        const auto [least, most] =
            network_detail::slope_range<Law>(p, L, (std::max)(l - reach, shortest), l + reach);
        return {(std::min)(least, t.axial), (std::max)(most, t.axial)};
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
        if constexpr (std::is_trivially_copyable_v<Parameters>) {
            parameters.resize(count);
        } else {
            parameters.erase(parameters.begin() + static_cast<std::ptrdiff_t>(count),
                             parameters.end());
        }
        if (!damping.empty()) damping.resize(count);
    }
};

namespace network_detail {

/// Where a system keeps the springs of a law.
template <class Scalar, class Law>
using SetOf = SpringSet<Scalar, usable_law<Law, Scalar>>;

}  // namespace network_detail
}  // namespace taut
