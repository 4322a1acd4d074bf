// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "../../core/concepts.hpp"
#include "../../core/method.hpp"

namespace taut::detail {

/// The energy of a pose and what makes it oscillate under the explicit steps.
struct EnergyBooks {
    double kinetic = 0;  ///< of the free particles, J
    double elastic = 0;  ///< of the springs, J
    double gravity = 0;  ///< −Σ m g·x over the free particles, J
    double heights = 0;  ///< Σ m|g·x|, J: what the rounding of `gravity` is relative to
    double power = 0;    ///< vᵀf of springs and gravity, W
    double jerk = 0;     ///< fᵀM⁻¹f of the same, W/s

    double energy() const { return kinetic + elastic + gravity; }

    /// The energy that a step of h keeps exactly on a linear undamped scene: for symplectic Euler
    /// H + ½h vᵀf, for velocity Verlet H − ⅛h² fᵀM⁻¹f. Implicit steps keep none, and lose.
    double kept(Method method, double h) const {
        switch (method) {
            case Method::symplectic_euler: return energy() + h / 2 * power;
            case Method::velocity_verlet: return energy() - h * h / 8 * jerk;
            default: return energy();
        }
    }
};

/// Fills the books in one pass over the springs, sums in double; f ← the force of springs, and of
/// gravity on free particles, N, Dim × n.
template <class System, class State, class Force>
EnergyBooks energy_books(const System& system, const State& state, Force& f) {
    using Vector = typename System::Vector;
    using Scalar = typename System::Scalar;
    EnergyBooks books;
    f.resize(System::Dim, system.size());
    const auto inverse_mass = system.inverse_mass();
    for (Index i = 0; i < system.size(); ++i) {
        f.col(i) = system.is_pinned(i) ? Vector(Vector::Zero())
                                       : Vector(system.mass(i) * system.gravity());
    }
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const Vector dx = state.x.col(set.b[s]) - state.x.col(set.a[s]);
            const Scalar l = dx.norm();
            const auto& p = set.parameters[s];
            const Scalar L = set.rest_length[s];
            books.elastic += static_cast<double>(Law::energy(p, L, l));
            if (!(l > 0)) continue;
            const Vector pull = (Law::tension(p, L, l) / l) * dx;
            f.col(set.a[s]) += pull;
            f.col(set.b[s]) -= pull;
        }
    });
    for (Index i = 0; i < system.size(); ++i) {
        const Scalar w = inverse_mass[i];
        if (w == Scalar(0)) continue;
        const Scalar mass = system.mass(i);
        const auto height = static_cast<double>(mass * system.gravity().dot(state.x.col(i)));
        books.kinetic += 0.5 * static_cast<double>(mass * state.v.col(i).squaredNorm());
        books.gravity -= height;
        books.heights += std::abs(height);
        books.power += static_cast<double>(f.col(i).dot(state.v.col(i)));
        books.jerk += static_cast<double>(w * f.col(i).squaredNorm());
    }
    return books;
}

/// The free particle with the most kinetic energy, or −1.
template <class System, class State>
Index fastest_particle(const System& system, const State& state) {
    Index found = -1;
    double most = -1;
    for (Index i = 0; i < system.size(); ++i) {
        const double energy = static_cast<double>(system.mass(i)) *
                              state.v.col(i).template cast<double>().squaredNorm();
        if (!system.is_pinned(i) && energy > most) {
            most = energy;
            found = i;
        }
    }
    return found;
}

/// The spring that holds the most energy, or −1; it counts the laws in their order.
template <class System, class State>
Index fullest_spring(const System& system, const State& state) {
    Index found = -1;
    Index index = 0;
    double most = -1;
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s, ++index) {
            const auto dx = (state.x.col(set.b[s]) - state.x.col(set.a[s])).template cast<double>();
            const double energy = Law::energy(set.parameters[s].template cast<double>(),
                                              static_cast<double>(set.rest_length[s]), dx.norm());
            if (energy > most) {
                most = energy;
                found = index;
            }
        }
    });
    return found;
}

}  // namespace taut::detail
