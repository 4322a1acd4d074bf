// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "../stability/any_pose.hpp"
#include "detail/energy_audit.hpp"
#include "detail/last_state.hpp"

namespace taut {
namespace detail {

template <class Stepper>
struct stepped_system;
template <template <class...> class Stepper, class System, class... Policies>
struct stepped_system<Stepper<System, Policies...>> {
    using type = System;
};

template <class Stepper>
using method_of = decltype(Stepper::method);
template <class Stepper>
using constraint_forces_of = decltype(std::declval<const Stepper&>().constraint_forces());

/// What the guard takes a stepper for; one without a `method` counts as implicit.
template <class Stepper>
constexpr Method guarded_method() {
    if constexpr (is_detected_v<method_of, Stepper>) {
        return Stepper::method;
    } else {
        return Method::implicit_euler;
    }
}

}  // namespace detail

/// Why the guard took a frame back.
enum class Alarm {
    none,
    step_failed,  ///< a substep did not succeed: its state was not finite, or its solver failed
    energy        ///< the energy rose by more than anything did work
};

/// Outcome of Guarded::advance; false when the frame was given up, and then the state is that of
/// its start.
template <class Scalar>
struct [[nodiscard]] GuardedReport {
    Status status = Status::ok;
    Alarm alarm = Alarm::none;  ///< of the last attempt that was taken back
    Index substeps = 0;         ///< of the last attempt
    Scalar h = 0;               ///< its step, s
    int retries = 0;
    Scalar advanced = 0;     ///< s; less than the frame if max_substeps cut it, 0 on failure
    double energy_rise = 0;  ///< J, beyond all work, in the last attempt that finished
    Index particle = -1;     ///< on failure: the first one not finite, or the fastest
    Index spring = -1;       ///< on failure: the one with the most energy

    explicit operator bool() const { return status == Status::ok; }
};

/// Advances whole frames by a stepper on a SpringSystem, and cannot explode unnoticed.
///
/// A frame is cut into equal substeps of at most safety·any_pose_limit [T23], renewed whenever the
/// system's revision() has moved on; implicit steppers take options.max_step. At its end the state
/// must be finite, and the energy that the method keeps on a linear scene (for symplectic Euler
/// H + ½h vᵀf) may have risen by the work of external forces and moving pins and by a slack. Else
/// the frame is taken back to its start and tried again with twice the substeps. A rise that half
/// the step repeats is the scene's own (a force with an energy source), and is let pass.
///
/// The audit of a frame costs one and a half explicit steps. It catches what no analysis sees:
/// stiff external forces, and implicit steps that overshoot. A collision response between frames is
/// not judged: each frame is measured from its own start.
/// @tparam Stepper  SymplecticEuler, VelocityVerlet, ImplicitEuler, Bdf2 of a SpringSystem
template <class Stepper, class System = typename detail::stepped_system<Stepper>::type>
class Guarded {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr Method method = detail::guarded_method<Stepper>();
    static_assert(method != Method::explicit_euler,
                  "taut::Guarded: explicit Euler has no limit that holds at every pose; guard "
                  "SymplecticEuler, which costs the same");

    static_assert(!detail::is_detected_v<detail::constraint_forces_of, Stepper>,
                  "taut::Guarded: the energy audit does not know the work of constraints");

    struct Options {
        Scalar safety = static_cast<Scalar>(0.95);  ///< of the any-pose limit, in (0, 1]
        Scalar max_step = std::numeric_limits<Scalar>::infinity();  ///< s, > 0
        /// A frame that needs more is shortened to this many steps, so that a late frame does not
        /// make the next one later. Retries go beyond it.
        Index max_substeps = 1000;
        int max_retries = 3;  ///< each with twice the substeps
        /// Admitted rise of the energy in a frame, relative to kinetic and elastic energy at its
        /// start and the work done in it.
        double energy_slack = 0.01;
    };

    /// Keeps a reference: the system must outlive the guard. Options out of range go to fail().
    explicit Guarded(const System& system, const Options& options = {});
    explicit Guarded(const System&&, const Options& = {}) = delete;

    /// Advances by `frame`, s, finite and > 0. No certified step (overflow) is invalid_step.
    GuardedReport<Scalar> advance(State& state, Scalar frame);
    /// The same on an engine's own arrays, copied there and back once a frame.
    template <class Stored>
    GuardedReport<Scalar> advance(StateView<Stored, System::Dim>& view, Scalar frame) {
        view.copy_to(viewed_);
        const auto report = advance(viewed_, frame);
        if (report) view.copy_from(viewed_);
        return report;
    }

    Stepper& stepper() { return stepper_; }
    /// The limit in force; nothing before the first frame of an explicit stepper.
    const std::optional<StepLimit<Scalar>>& limit() const { return limit_; }

private:
    static constexpr bool limited =
        method == Method::symplectic_euler || method == Method::velocity_verlet;

    Scalar largest_step();
    void open_books(const State& state);
    double work(const State& state) const;
    bool admits(const State& state, double earlier, GuardedReport<Scalar>& report);
    void name_culprits(GuardedReport<Scalar>& report, const State& failed);

    const System* system_;
    Options options_;
    Stepper stepper_;
    std::optional<StepLimit<Scalar>> limit_;
    detail::LastState<State> start_;  // the last good one, and its books
    detail::EnergyBooks books_;
    typename System::Force force_;     // of springs and gravity at start_, N
    typename System::Force external_;  // N
    detail::EnergyBooks end_books_;
    typename System::Force end_force_;
    typename System::Force end_external_;
    State viewed_;  // of a StateView
};

template <class Stepper, class System>
Guarded<Stepper, System>::Guarded(const System& system, const Options& options)
    : system_(&system), options_(options), stepper_(system) {
    require_positive("Guarded", "safety", options.safety);
    if (options.safety > 1) fail("Guarded: safety is ", options.safety, "; it must be <= 1");
    if (!(options.max_step > 0)) {
        fail("Guarded: max_step is ", options.max_step, "; it must be > 0");
    }
    if (options.max_substeps < 1) {
        fail("Guarded: max_substeps is ", options.max_substeps, "; it must be >= 1");
    }
    if (options.max_retries < 0) {
        fail("Guarded: max_retries is ", options.max_retries, "; it must be >= 0");
    }
    require_non_negative("Guarded", "energy_slack", options.energy_slack);
}

/// 0 when no step is certified.
template <class Stepper, class System>
auto Guarded<Stepper, System>::largest_step() -> Scalar {
    if constexpr (limited) {
        if (!limit_ || !limit_->step_for(*system_, options_.safety)) {
            limit_ = any_pose_limit(*system_);
        }
        return std::min(options_.max_step,
                        limit_->step_for(*system_, options_.safety).value_or(Scalar(0)));
    } else {
        return options_.max_step;
    }
}

template <class Stepper, class System>
void Guarded<Stepper, System>::open_books(const State& state) {
    if (start_.is(*system_, state)) return;
    start_.keep(*system_, state);
    books_ = detail::energy_books(*system_, state, force_);
    system_->external_force(state, external_);
}

/// Of external forces and of the pins that moved, from start_ to `state`, J: forces averaged over
/// both ends.
template <class Stepper, class System>
double Guarded<Stepper, System>::work(const State& state) const {
    double sum = 0;
    for (Index i = 0; i < system_->size(); ++i) {
        const typename System::Vector path = state.x.col(i) - start_.state().x.col(i);
        if (system_->is_pinned(i)) {
            sum -= 0.5 * static_cast<double>((force_.col(i) + end_force_.col(i)).dot(path));
        } else {
            sum += 0.5 * static_cast<double>((external_.col(i) + end_external_.col(i)).dot(path));
        }
    }
    return sum;
}

/// Whether the energy at the end of a frame may be what it is; `earlier` is the rise of the attempt
/// before, or NaN. An instability of the step changes by orders of magnitude with half the step.
template <class Stepper, class System>
bool Guarded<Stepper, System>::admits(const State& state, double earlier,
                                      GuardedReport<Scalar>& report) {
    end_books_ = detail::energy_books(*system_, state, end_force_);
    system_->external_force(state, end_external_);
    const auto h = static_cast<double>(report.h);
    const double added = work(state);
    report.energy_rise = end_books_.kept(method, h) - books_.kept(method, h) - added;
    const double fallen = std::max(0.0, books_.gravity - end_books_.gravity);
    const double moved = books_.kinetic + books_.elastic + fallen + std::abs(added);
    constexpr double rounding = 64 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    const double slack = options_.energy_slack * moved + rounding * (moved + books_.heights);
    const double rise = report.energy_rise;
    return rise <= slack || std::abs(rise - earlier) <= slack + 0.25 * std::min(rise, earlier);
}

/// From the end of a frame that gained energy, or, if a substep failed, from the last state before.
template <class Stepper, class System>
void Guarded<Stepper, System>::name_culprits(GuardedReport<Scalar>& report, const State& failed) {
    State last = failed;
    for (Index i = 0; report.alarm == Alarm::step_failed && i < report.substeps; ++i) {
        if (!stepper_.step(last, report.h)) break;
    }
    if (report.particle < 0) report.particle = detail::fastest_particle(*system_, last);
    report.spring = detail::fullest_spring(*system_, last);
}

template <class Stepper, class System>
auto Guarded<Stepper, System>::advance(State& state, Scalar frame) -> GuardedReport<Scalar> {
    GuardedReport<Scalar> report;
    const Scalar largest = largest_step();
    const bool fits = state.x.cols() == system_->size() && state.v.cols() == system_->size();
    if (!(frame > 0) || !std::isfinite(frame) || !(largest > 0)) {
        report.status = Status::invalid_step;
    } else if (!fits || !state.finite()) {
        report.status = Status::invalid_state;
        report.particle = fits ? state.first_not_finite() : -1;
    }
    if (!report) return report;
    open_books(state);

    const double needed = std::ceil(static_cast<double>(frame) / static_cast<double>(largest));
    const bool late = needed > static_cast<double>(options_.max_substeps);
    report.substeps = late ? options_.max_substeps : std::max(Index(1), static_cast<Index>(needed));
    const Scalar span = late ? largest * static_cast<Scalar>(report.substeps) : frame;
    report.h = span / static_cast<Scalar>(report.substeps);

    double earlier = std::numeric_limits<double>::quiet_NaN();  // energy_rise of the last attempt
    for (;; ++report.retries, report.substeps *= 2, report.h /= 2) {
        const Report step = stepper_.step(state, report.h, report.substeps);
        report.status = step.status;
        report.particle = step.where;
        if (!step) {
            report.alarm = Alarm::step_failed;
            earlier = std::numeric_limits<double>::quiet_NaN();
        } else if (admits(state, earlier, report)) {
            break;
        } else {
            report.alarm = Alarm::energy;
            report.status = Status::diverged;
            earlier = report.energy_rise;
        }
        if (report.retries == options_.max_retries) {
            name_culprits(report, state);
            state = start_.state();
            return report;
        }
        state = start_.state();
    }
    report.advanced = span;
    start_.keep(*system_, state);
    std::swap(books_, end_books_);
    std::swap(force_, end_force_);
    std::swap(external_, end_external_);
    return report;
}

}  // namespace taut
