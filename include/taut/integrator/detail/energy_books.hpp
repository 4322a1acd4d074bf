// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../core/types.hpp"
#include "../../method/visit.hpp"
#include "../../model/spring_set.hpp"
#include "pin_work.hpp"

namespace taut::integrator_detail {

/// The energy of a state, and what makes it oscillate under the explicit steps.
struct EnergyBooks {
    double kinetic = 0;           ///< T, of the free particles, J
    double elastic = 0;           ///< V, of the springs, J
    double gravity = 0;           ///< G = −Σ m g·x over the free particles, J
    double power = 0;             ///< v·f over all particles, f of springs and gravity, W
    double fall_power = 0;        ///< gravity's part of it, W
    double pin_power = 0;         ///< the pinned particles' part of it, W
    double dissipation = 0;       ///< vᵀDv of the system's damping, W
    double step_dissipation = 0;  ///< vᵀAv of a stepper's own damping hA, W/s
    double force_norm = 0;  ///< fᵀM⁻¹f over the free particles, W/s; velocity Verlet only
    double pull_norm = 0;   ///< the same of springs alone, W/s; velocity Verlet only
    double rounding = 0;    ///< what rounding may make of all this, J

    /// Counts further kinetic energy, J, of particles in Scalars with that epsilon.
    void add_kinetic(double energy, double epsilon) {
        kinetic += energy;
        rounding += 8 * epsilon * energy;
    }
    /// T + V: what moves or pulls, never negative.
    double owned() const { return kinetic + elastic; }
    /// H = T + V + G.
    double total() const { return owned() + gravity; }

    /// The energy that steps of h keep on a linear scene, up to what moving pins do, and that
    /// damping lowers [T36]: the descriptor's kept_energy. Implicit steps keep none; they lose H.
    double kept(Method method, double h) const {
        return method::visit(
            method, [&](auto descriptor) { return decltype(descriptor)::kept_energy(*this, h); });
    }
    /// vᵀDv of all damping at steps of h, W.
    double braking(double h) const { return dissipation + h * step_dissipation; }
    /// The part of kept() that gravity and moving pins have in what oscillates, J. Without G and
    /// this, kept() lies within a share of E = T + V that the step alone sets [T36].
    double lag(Method method, double h) const {
        return method::visit(
            method, [&](auto descriptor) { return decltype(descriptor)::energy_lag(*this, h); });
    }
};

/// The springs' share of the books; f ← f + their force where Forces.
/// @param share  the stepper's own damping, by its step
/// @param reach  the largest coordinate, m
template <bool Forces, class System, class State, class Force>
void add_spring_books(const System& system, const State& state,
                      const StiffnessDamping<double>& share, double reach, EnergyBooks& books,
                      Force& f) {
    using Vector = typename System::Vector;
    using Scalar = typename System::Scalar;
    constexpr double unit = 4 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    const auto own = system.stiffness_damping();
    const bool proportional = own || share;
    system.for_each_set([&](const auto& set) {
        const bool damped = proportional || !set.damping.empty();
        double elastic = 0, power = 0, force_sum = 0, stiffness_sum = 0;
        double dissipation = 0, step_dissipation = 0;
        Scalar longest = 0;
        for (const auto spring : set) {
            const Vector dx = state.x.col(spring.b) - state.x.col(spring.a);
            const Vector dv = state.v.col(spring.b) - state.v.col(spring.a);
            const Scalar l = spring_length(dx);
            const Scalar T = spring.tension(l);
            longest = l > longest ? l : longest;
            force_sum += static_cast<double>(std::abs(T));
            stiffness_sum += static_cast<double>(spring.stiffness_bound());
            elastic += static_cast<double>(spring.energy(l));
            const Scalar over_l = T / l;
            if (damped) {
                const auto braking = braking_of(spring, dx, dv, l, over_l);
                dissipation += braking.damper + braking.of(own);
                step_dissipation += braking.of(share);
            }
            power -= static_cast<double>(over_l * dx.dot(dv));
            if constexpr (Forces) {
                f.col(spring.a) += over_l * dx;
                f.col(spring.b) -= over_l * dx;
            }
        }
        const double grain = unit * (reach + static_cast<double>(longest));
        books.rounding += force_sum * grain + stiffness_sum * grain * grain;
        books.elastic += elastic;
        books.power += power;
        books.dissipation += dissipation;
        books.step_dissipation += step_dissipation;
    });
}

/// Fills the books in one pass over springs and one over particles, sums in double.
/// @param pins   of the same system, kept from one call to the next
/// @param f      workspace of velocity Verlet, Dim × n
/// @param share  the stepper's own damping, by its step
template <class System, class State, class Force>
EnergyBooks energy_books(const System& system, const State& state, Method method,
                         PinWork<System>& pins, Force& f,
                         const StiffnessDamping<double>& share = {}) {
    using Scalar = typename System::Scalar;
    constexpr double unit = 4 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    EnergyBooks books;
    const double reach =
        system.size() == 0 ? 0 : static_cast<double>(state.x.cwiseAbs().maxCoeff());
    const bool forces = method::visit(
        method, [](auto descriptor) { return decltype(descriptor)::averages_forces; });
    if (forces) {
        f.setZero(System::Dim, system.size());
        add_spring_books<true>(system, state, share, reach, books, f);
    } else {
        add_spring_books<false>(system, state, share, reach, books, f);
    }
    const double d0 = system.rayleigh().mass_proportional;
    const auto inverse_mass = system.inverse_mass();
    for (Index i = 0; i < system.size(); ++i) {
        const Scalar w = inverse_mass[i];
        if (w == Scalar(0)) continue;
        const Scalar mass = system.mass(i);
        const auto height = static_cast<double>(mass * system.gravity().dot(state.x.col(i)));
        const auto speed = static_cast<double>(mass * state.v.col(i).squaredNorm());
        books.gravity -= height;
        books.kinetic += speed / 2;
        books.dissipation += d0 * speed;
        books.fall_power += static_cast<double>(mass * system.gravity().dot(state.v.col(i)));
        books.rounding += unit * (std::abs(height) + speed);
        if (!forces) continue;
        books.force_norm +=
            static_cast<double>(w * (f.col(i) + mass * system.gravity()).squaredNorm());
        books.pull_norm += static_cast<double>(w * f.col(i).squaredNorm());
    }
    books.power += books.fall_power;
    if (pins.moves(system, state)) books.pin_power = pins.spring_power(system, state);
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
Index most_loaded_spring(const System& system, const State& state) {
    Index found = -1;
    Index index = 0;
    double most = -1;
    system.visit_springs([&](const auto& spring) {
        const auto dx = (state.x.col(spring.b) - state.x.col(spring.a)).template cast<double>();
        const double energy = spring.template cast<double>().energy(dx.norm());
        if (energy > most) {
            most = energy;
            found = index;
        }
        ++index;
    });
    return found;
}

}  // namespace taut::integrator_detail
