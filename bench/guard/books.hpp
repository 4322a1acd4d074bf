// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <taut/guard/report.hpp>
#include <taut/network/spring_system.hpp>
#include <vector>

// What Guarded's promise [T43] is judged by: energies in long double, written from their
// definitions with nothing of the guard in them.

namespace guard_books {

using taut::Index;
using Real = long double;

/// A scene's energies, J, summed over its parts.
struct Books {
    Real energy = 0;   ///< E: kinetic, of springs and of gravity
    Real kinetic = 0;  ///< K, that of each part about its centre of mass, unless it hangs on a pin
    Real moving = 0;   ///< kinetic energy of the free particles
    Real size = 0;     ///< Σ of what E is the difference of: the scale of its rounding
    Real hidden = 0;   ///< what underflow may hide
};

/// Free particles that springs join, by a particle of each: −1 for a pin.
template <class System>
std::vector<Index> parts_of(const System& system) {
    std::vector<Index> parent(static_cast<std::size_t>(system.size()));
    std::iota(parent.begin(), parent.end(), Index(0));
    const auto root = [&](Index i) {
        while (parent[i] != i) i = parent[i];
        return i;
    };
    system.for_each_spring([&](Index a, Index b) {
        if (!system.is_pinned(a) && !system.is_pinned(b)) parent[root(a)] = root(b);
    });
    std::vector<Index> part(parent.size());
    for (Index i = 0; i < system.size(); ++i) part[i] = system.is_pinned(i) ? -1 : root(i);
    return part;
}

template <class System>
Books books_of(const System& system, const typename System::State& state,
               const std::vector<Index>& part) {
    constexpr int Dim = System::Dim;
    using Vector = Eigen::Matrix<Real, Dim, 1>;
    // A length is √ of a square that may be lost.
    const Real underflow = std::sqrt(Real(std::numeric_limits<typename System::Scalar>::min()));
    Books books;
    std::vector<Real> mass(part.size(), 0);
    std::vector<Vector> momentum(part.size(), Vector::Zero());
    const Vector gravity = system.gravity().template cast<Real>();
    for (Index i = 0; i < system.size(); ++i) {
        if (part[i] < 0) continue;
        const Vector x = state.x.col(i).template cast<Real>();
        const Vector v = state.v.col(i).template cast<Real>();
        const Real m = system.mass(i);
        books.moving += m * v.squaredNorm() / 2;
        books.energy += m * v.squaredNorm() / 2 - m * gravity.dot(x);
        books.size += m * v.squaredNorm() + m * gravity.norm() * x.norm();
        books.hidden += 8 * m * (1 + gravity.norm()) * underflow * underflow;
        mass[part[i]] += m;
        momentum[part[i]] += m * v;
    }
    std::vector<bool> hangs(part.size(), false);
    system.for_each_spring([&](Index a, Index b) {
        if ((part[a] < 0) != (part[b] < 0)) hangs[std::max(part[a], part[b])] = true;
    });
    books.kinetic = books.moving;
    for (std::size_t p = 0; p < part.size(); ++p) {
        if (mass[p] > 0 && !hangs[p]) books.kinetic -= momentum[p].squaredNorm() / mass[p] / 2;
    }
    books.kinetic = std::max(books.kinetic, Real(0));
    system.visit_springs([&](const auto& narrow) {
        if (part[narrow.a] < 0 && part[narrow.b] < 0) return;
        const auto spring = narrow.template cast<Real>();
        const Vector a = state.x.col(spring.a).template cast<Real>();
        const Vector b = state.x.col(spring.b).template cast<Real>();
        const Real l = (b - a).norm();
        books.energy += spring.energy(l);
        books.size += spring.stiffness_bound() * (l + spring.rest_length) *
                      (a.norm() + b.norm() + spring.rest_length);
        books.hidden += 8 * spring.stiffness_bound() * (1 + spring.rest_length) * underflow;
    });
    return books;
}
template <class System>
Books books_of(const System& system, const typename System::State& state) {
    return books_of(system, state, parts_of(system));
}

/// E_n ≤ E_m + 0.1 K_m + ΣW + d_n for all m < n at once: the least right side of every m so far. d
/// is the guard's word, which may be no more than ρ and that of the frames taken again.
class Promise {
public:
    /// @param unit  the unit roundoff of what the guard measures in   @param start  of the first
    /// frame
    Promise(double unit, const Books& start)
        : unit_(unit), allowed_(start.energy + start.kinetic / 10 + rounding(start)) {}
    /// Whoever edits the scene changes E; what is pinned takes with it what it owes. The guard
    /// measures on both sides.
    void edit(const Books& before, const Books& after) {
        scale_ = std::max({scale_, before.size, after.size});
        allowed_ += after.energy - before.energy + owing_ + rounding(before) + rounding(after);
    }
    /// A frame that ended so. @returns whether it kept the promise
    /// @param report  of the guard   @param unseen  what rounding may hide beside ρ, J
    /// @param by_code  whether forces are code
    template <class Report>
    bool keeps(const Books& end, const Report& report, double unseen = 0, bool by_code = false) {
        allowed_ += Real(report.work) + unseen;
        rounded_ += unseen;
        if (report.taken >= taut::Taken::again) rounded_ += report.slack;
        scale_ = std::max({scale_, end.size, std::abs(allowed_)});
        hidden_ = std::max(hidden_, end.hidden);
        // An edit may take away most of E.
        const Real grain = rounding(end) + 1e-13L * scale_ + hidden_;
        over_ = end.energy - allowed_ - report.balance;
        const Real owed =
            report.slack + unseen + (report.taken >= taut::Taken::again ? rounded_ : 0);
        // The parts' balances are known as a sum, and none is below −0.1 K of its part.
        owing_ = std::max(Real(0), report.balance + end.kinetic / 10);
        // What forces given as code change in steps that are taken again is owed, too.
        const bool stands = !by_code || report.taken < taut::Taken::again;
        const bool owes = stands && report.balance > owed + grain + 2e-12L * end.kinetic;
        const bool kept = !(over_ > grain) && !owes;
        // Forces given as code hold back up to σ.
        allowed_ = std::min(
            allowed_, end.energy + end.kinetic / 10 + rounding(end) + (by_code ? report.slack : 0));
        return kept;
    }
    /// By how much the last frame was above what is allowed, J; below 0 if it was not.
    Real over() const { return over_; }

private:
    /// The guard measures an energy in a few roundings of its own.
    Real rounding(const Books& books) const { return 8 * unit_ * books.size; }

    Real unit_;
    Real allowed_;
    Real over_ = 0;
    Real rounded_ = 0;  // Σρ of the frames taken again, J
    Real owing_ = 0;    // d where it is above 0, J
    Real hidden_ = 0;
    Real scale_ = 0;  // the largest energy so far, J
};

}  // namespace guard_books
