// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "../core/types.hpp"

namespace taut {

/// One spring with its rest length given, for SpringSystem::add_spring.
template <class Scalar, class Law>
struct Spring {
    Index a;
    Index b;
    typename Law::template Parameters<Scalar> parameters;
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

/// axial·d dᵀ + transverse·(I − d dᵀ), symmetric to the bit.
template <class Vector, class Scalar = typename Vector::Scalar>
auto spring_block(const Vector& d, Scalar axial, Scalar transverse) {
    using Block = Eigen::Matrix<Scalar, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime>;
    Block P = d * d.transpose();  // before the factor, which would round the two triangles apart
    P *= axial - transverse;
    P.diagonal().array() += transverse;
    return P;
}

/// The springs of one law: structure of arrays, without damping until a damped one is added.
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

    /// The tangent of spring s with its ends at x, in the precision of x. At l = 0, and where l
    /// overflows, it is the law's bound times the identity: no tangent is larger.
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
        const Real l = t.d.norm();
        if (l > 0 && std::isfinite(l)) {
            t.d /= l;
            t.axial = Law::tension_slope(p, L, l);
            t.transverse = Law::tension(p, L, l) / l;
        } else {
            t.d.setZero();
            t.axial = t.transverse = t.bound;
        }
        return t;
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

}  // namespace taut
