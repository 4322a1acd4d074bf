// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../core/types.hpp"
#include "../../method/visit.hpp"
#include "last_state.hpp"
#include "pin_work.hpp"

namespace taut::integrator_detail {

/// Measures what is done on a scene from outside, step by step, by the rule under which the
/// method's kept energy changes by exactly that work on a linear scene [T36].
template <class System, class Descriptor>
class WorkMeter {
public:
    using State = typename System::State;
    using Force = typename System::Force;

    /// Forgets what was measured; steps of h, s, follow.
    /// @param resolved  h²κ and hδ up to which a force of stiffness κ and damping δ, per mass,
    ///                  counts as resolved
    /// @param added     the stepper's own damping, StepDamping::times(h)
    void start(double h, double resolved, const StepDamping& added = {}) {
        h_ = h;
        resolved_ = resolved;
        added_ = added;
        work_ = in_doubt_ = unresolved_ = thrown_ = 0;
        force_known_ = false;
    }
    /// Whether anything works on the scene that must be followed step by step.
    bool needed(const System& system, const State& state) {
        return system.has_external_force() || pins_.moves(system, state);
    }
    /// Before a step.
    /// @param touched  whether the state is other than the last step left it
    /// @param held     whether the step may have constraints
    void depart(const System& system, const State& state, bool touched, bool held) {
        moving_pins_ = pins_.moves(system, state);
        external_ = system.has_external_force();
        if (external_ || held) x_ = state.x;
        if (moving_pins_) pin_power_ = damped_pin_power(system, state);
        if (!external_) return;
        if (!Descriptor::is_implicit) v_ = state.v;
        // Velocity Verlet itself goes on with the force of its last step where it can.
        const bool known =
            Descriptor::averages_forces ? last_.is(system, state) : force_known_ && !touched;
        if (known) return;
        system.external_force(state, force_);
        felt_v_ = state.v;
    }
    /// After it. @param held  forces of constraints in this step, N, Dim × n; may be null or empty
    void arrive(const System& system, const State& state, const Force* held) {
        if (external_) add_external(system, state);
        if (moving_pins_) {
            work_ -= h_ * (Descriptor::is_implicit ? damped_pin_power(system, state) : pin_power_);
        }
        if (held != nullptr && held->cols() > 0) {
            work_ += static_cast<double>(held->cwiseProduct(state.x - x_).sum());
        }
    }
    /// The pins of the system that is measured, for its books.
    PinWork<System>& pins() { return pins_; }
    /// Work that somebody claims to have done, J.
    void add(double work) { work_ += work; }

    /// J.
    double work() const { return work_; }
    /// J; of this, by forces that the step does not resolve.
    double in_doubt() const { return in_doubt_; }
    /// J; what such a force may have added or lost by its change with x: half the change times the
    /// way.
    double unresolved() const { return unresolved_; }
    /// J; the most that brakes which turn within a step have thrown back in one. Dry friction at
    /// rest turns in every step and throws back the same; a drag that explodes throws back more and
    /// more.
    double thrown() const { return thrown_; }

private:
    using Scalar = typename System::Scalar;
    using Vector = Eigen::Matrix<double, System::Dim, 1>;

    double damped_pin_power(const System& system, const State& state) {
        return pins_.damped_power(system, state, added_);
    }
    void add_external(const System& system, const State& state) {
        end_ = state;
        if (Descriptor::averages_forces) end_.v = (state.x - x_) / static_cast<Scalar>(h_);
        system.external_force(end_, next_force_);
        bool doubtful = false;
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            work_ += work_on(system, state, i);
            const Vector df = column(next_force_, i) - column(force_, i);
            doubtful = doubtful || stiff(system, i, df, true) || stiff(system, i, df, false);
        }
        if (doubtful) doubt(system, state);
        std::swap(force_, next_force_);
        std::swap(felt_v_, end_.v);
        force_known_ = true;
        if (Descriptor::averages_forces) last_.keep(system, state);
    }
    double work_on(const System& system, const State& state, Index i) const {
        const Vector f = column(force_, i);
        if (Descriptor::is_implicit) return f.dot(way(i));
        const Vector v = column(v_, i);
        if (!Descriptor::averages_forces) return f.dot(way(i) + h_ * v) / 2;
        const Vector last = column(next_force_, i);
        const double squares = (last - f).dot(last + f) / static_cast<double>(system.mass(i));
        return h_ / 2 * (f.dot(v) + last.dot(column(state.v, i))) - h_ * h_ / 8 * squares;
    }
    /// Whether a force that changes by df in this step, by x or by v, is too stiff for it; of both
    /// signs, for either may hide the other.
    bool stiff(const System& system, Index i, const Vector& df, bool by_way) const {
        const Vector change = by_way ? Vector(way(i) / h_) : turn(i);
        return h_ * std::abs(df.dot(change)) >
               resolved_ * static_cast<double>(system.mass(i)) * change.squaredNorm();
    }
    /// Tells what changed by x from what changed by v, by the force at the end with the velocities
    /// of the start.
    void doubt(const System& system, const State& state) {
        probe_.x = end_.x;
        probe_.v = felt_v_;
        probe_.time = end_.time;
        system.external_force(probe_, probe_force_);
        double thrown = 0;
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            const Vector by_x = column(probe_force_, i) - column(force_, i);
            const Vector by_v = column(next_force_, i) - column(probe_force_, i);
            const double against = -by_x.dot(way(i));
            const bool stiff_in_x = against > 0 && stiff(system, i, by_x, true);
            const bool stiff_in_v = by_v.dot(turn(i)) < 0 && stiff(system, i, by_v, false);
            if (stiff_in_x) unresolved_ += against / 2;
            const auto mass = static_cast<double>(system.mass(i));
            if (stiff_in_v) thrown += h_ * h_ * by_v.squaredNorm() / (8 * mass);
            if (stiff_in_x || stiff_in_v) in_doubt_ += work_on(system, state, i);
        }
        thrown_ = std::max(thrown_, thrown);
    }
    template <class Field>
    static Vector column(const Field& field, Index i) {
        return field.col(i).template cast<double>();
    }
    Vector way(Index i) const { return column(end_.x, i) - column(x_, i); }
    Vector turn(Index i) const { return column(end_.v, i) - column(felt_v_, i); }

    PinWork<System> pins_;
    LastState<State> last_;  // what force_ belongs to; velocity Verlet only
    Force x_;                // at the step's start, m; if an external force or constraint works
    Force v_;                // m/s; if an external force works in an explicit step
    Force force_;            // external, at the step's start, N; if one works, like all below
    Force felt_v_;           // the velocities that it was taken at, m/s
    State end_;              // of the step; the velocities are those of next_force_
    Force next_force_;       // at its end, N
    State probe_;
    Force probe_force_;
    double pin_power_ = 0;  // on the pins at the step's start, W
    StepDamping added_;
    double h_ = 0;  // s
    double resolved_ = 0;
    double work_ = 0;        // J
    double in_doubt_ = 0;    // J
    double unresolved_ = 0;  // J
    double thrown_ = 0;      // J
    bool external_ = false;
    bool moving_pins_ = false;
    bool force_known_ = false;
};

}  // namespace taut::integrator_detail
