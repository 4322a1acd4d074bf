// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "../../core/concepts.hpp"
#include "../../core/method.hpp"

namespace taut::detail {

/// The energy of a pose and what makes it oscillate under the explicit steps.
struct EnergyBooks {
    double kinetic = 0;   ///< of the free particles, J
    double elastic = 0;   ///< of the springs, J
    double gravity = 0;   ///< −Σ m g·x over the free particles, J
    double rounding = 0;  ///< what the rounding of positions and forces may make of all this, J
    double power = 0;     ///< vᵀf of springs and gravity, W
    double jerk = 0;      ///< fᵀM⁻¹f of the same, W/s

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
    constexpr double unit = 64 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
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
            const Scalar T = Law::tension(p, L, l);
            const double grain =
                unit * (static_cast<double>(state.x.col(set.a[s]).norm()) + static_cast<double>(l));
            books.rounding += static_cast<double>(std::abs(T)) * grain +
                              static_cast<double>(Law::stiffness_bound(p, L)) * grain * grain / 64;
            books.elastic += static_cast<double>(Law::energy(p, L, l));
            if (!(l > 0)) continue;
            const Vector pull = (T / l) * dx;
            f.col(set.a[s]) += pull;
            f.col(set.b[s]) -= pull;
        }
    });
    for (Index i = 0; i < system.size(); ++i) {
        const Scalar w = inverse_mass[i];
        if (w == Scalar(0)) continue;
        const Scalar mass = system.mass(i);
        const auto height = static_cast<double>(mass * system.gravity().dot(state.x.col(i)));
        books.rounding += unit * std::abs(height);
        books.kinetic += 0.5 * static_cast<double>(mass * state.v.col(i).squaredNorm());
        books.gravity -= height;
        books.power += static_cast<double>(f.col(i).dot(state.v.col(i)));
        books.jerk += static_cast<double>(w * f.col(i).squaredNorm());
    }
    return books;
}

/// What the energy did on a stretch of time, against the work of external forces, moving pins and
/// constraints, J.
template <class System>
class EnergyAudit {
public:
    using State = typename System::State;
    using Force = typename System::Force;

    /// Starts at `state`.
    void open(const System& system, const State& state) {
        read(system, state, pages_[first_]);
        rewind();
    }
    /// Starts where the last stretch ended.
    void go_on() {
        first_ = last_;
        rewind();
    }
    /// Forgets all since the start.
    void rewind() {
        last_ = first_;
        work_ = 0;
        given_ = 0;
    }
    /// Steps have led to `state`; their work is by the mean of the forces at both ends of the way.
    /// @param held  forces of constraints on the way, N, Dim × n; may be null or empty
    void add_motion(const System& system, const State& state, const Force* held);
    /// Somebody else has made the last state into this one; its energy is no fault of the steps.
    void add_response(const System& system, const State& state, Method method, double h) {
        const double before = pages_[last_].books.kept(method, h);
        read(system, state, pages_[last_]);
        given_ += pages_[last_].books.kept(method, h) - before;
    }
    /// By how much the energy that steps of h keep has risen beyond all work.
    double rise(Method method, double h) const {
        return pages_[last_].books.kept(method, h) - pages_[first_].books.kept(method, h) - work_ -
               given_;
    }
    /// The energy that was there or was moved: what a rise is relative to.
    double moved() const {
        const EnergyBooks& start = pages_[first_].books;
        const double fallen = std::max(0.0, start.gravity - pages_[last_].books.gravity);
        return start.kinetic + start.elastic + fallen + std::abs(work_) + std::abs(given_);
    }
    /// What rounding may make of rise(), J.
    double rounding() const { return pages_[first_].books.rounding + pages_[last_].books.rounding; }

private:
    struct Page {
        EnergyBooks books;
        Force x;         // positions, m
        Force force;     // of springs and gravity, N
        Force external;  // N
    };
    static void read(const System& system, const State& state, Page& page) {
        page.books = energy_books(system, state, page.force);
        page.x = state.x;
        system.external_force(state, page.external);
        add_damping_on_moving_pins(system, state, page);
    }

    /// A moving pin works through dampers too.
    static void add_damping_on_moving_pins(const System& system, const State& state, Page& page) {
        bool moving = false;
        for (Index i = 0; i < system.size(); ++i) {
            moving = moving || (system.is_pinned(i) && !state.v.col(i).isZero(0));
        }
        if (!moving) return;
        Force all;
        system.force(state, all);
        const auto d0 = static_cast<typename System::Scalar>(system.rayleigh().mass_proportional);
        for (Index i = 0; i < system.size(); ++i) {
            if (!system.is_pinned(i)) continue;
            page.force.col(i) = all.col(i) - page.external.col(i) -
                                system.mass(i) * (system.gravity() - d0 * state.v.col(i));
        }
    }

    std::array<Page, 3> pages_;
    std::size_t first_ = 0;
    std::size_t last_ = 0;
    double work_ = 0;   // J
    double given_ = 0;  // by responses, J
};

template <class System>
void EnergyAudit<System>::add_motion(const System& system, const State& state, const Force* held) {
    const Page& from = pages_[last_];
    std::size_t next = 0;
    while (next == first_ || next == last_) ++next;
    Page& to = pages_[next];
    read(system, state, to);
    for (Index i = 0; i < system.size(); ++i) {
        const typename System::Vector path = to.x.col(i) - from.x.col(i);
        if (system.is_pinned(i)) {
            work_ -= 0.5 * static_cast<double>((from.force + to.force).col(i).dot(path));
        } else {
            work_ += 0.5 * static_cast<double>((from.external + to.external).col(i).dot(path));
        }
    }
    if (held != nullptr && held->cols() > 0) {
        work_ += static_cast<double>(held->cwiseProduct(to.x - from.x).sum());
    }
    last_ = next;
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
