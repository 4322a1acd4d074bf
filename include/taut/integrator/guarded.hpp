// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

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

struct NoResponse {
    template <class State>
    void operator()(State&) const {}
};

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

    /// Whether status is ok.
    explicit operator bool() const { return status == Status::ok; }
};

/// Advances whole frames by a stepper on a SpringSystem, and cannot explode unnoticed.
///
/// A frame is cut into equal substeps of at most safety·any_pose_limit [T23], renewed whenever the
/// system's revision() has moved on; implicit steppers take options.max_step. At its end the state
/// must be finite, and the energy that the method keeps on a linear scene (for symplectic Euler
/// H + ½h vᵀf) may have risen by no more than the work of external forces, moving pins and
/// constraints and a slack. Else the frame is taken back to its start and tried again with twice
/// the substeps, now with the work of every single one in the books.
///
/// The audit of a frame costs one and a half explicit steps, one of a retried frame as much a
/// substep. It catches what no analysis sees: stiff external forces, and implicit steps that
/// overshoot. What changes the state between frames is not judged.
/// @tparam Stepper  SymplecticEuler, VelocityVerlet, ImplicitEuler, Bdf2, ProjectiveDynamics or
///                  your own, of a SpringSystem; one without a `method` counts as implicit
template <class Stepper, class System = typename detail::stepped_system<Stepper>::type>
class Guarded {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr Method method = detail::guarded_method<Stepper>();
    static_assert(method != Method::explicit_euler,
                  "taut::Guarded: explicit Euler has no limit that holds at every pose; guard "
                  "SymplecticEuler, which costs the same");

    /// What a frame may cost, and what counts as a gain of energy.
    struct Options {
        Scalar safety = static_cast<Scalar>(0.95);  ///< of the any-pose limit, in (0, 1]
        Scalar max_step = std::numeric_limits<Scalar>::infinity();  ///< s, > 0
        /// A frame that needs more is shortened to this many steps, so that a late frame does not
        /// make the next one later. Retries go beyond it.
        Index max_substeps = 1000;
        int max_retries = 6;  ///< each with twice the substeps
        /// Share of the energy by which it may rise at once: of kinetic and elastic energy at the
        /// frame's start and the work done in it.
        double energy_slack = 0.01;
        /// And by which it may go on rising, 1/s: what the slack has admitted grows back this fast,
        /// or as the energy falls.
        double energy_drift = 0.1;
    };

    /// Keeps a reference: the system must outlive the guard. Options out of range go to fail().
    /// @param arguments  further ones of the stepper's constructor, such as its Options
    template <class... Arguments>
    explicit Guarded(const System& system, const Options& options = {}, Arguments&&... arguments);
    template <class... Arguments>
    explicit Guarded(const System&&, const Options& = {}, Arguments&&...) = delete;

    /// Advances by `frame`, s, finite and > 0. No certified step (overflow) is invalid_step.
    /// @param respond  respond(state) after every substep: contacts, for example. What it does to
    ///                 the energy is not judged. It is called in attempts that are taken back, too.
    template <class Respond = detail::NoResponse>
    GuardedReport<Scalar> advance(State& state, Scalar frame, Respond&& respond = {});
    /// The same on an engine's own arrays, copied back once a frame, and there if they are not what
    /// the last frame left.
    template <class Stored, class Respond = detail::NoResponse>
    GuardedReport<Scalar> advance(StateView<Stored, System::Dim>& view, Scalar frame,
                                  Respond&& respond = {}) {
        if (!holds(view)) view.copy_to(viewed_);
        const auto report = advance(viewed_, frame, respond);
        if (report) view.copy_from(viewed_);
        return report;
    }

    /// The guarded stepper, to set its constraints or its solver.
    Stepper& stepper() { return stepper_; }
    /// The limit in force; nothing before the first frame of an explicit stepper.
    const std::optional<StepLimit<Scalar>>& limit() const { return limit_; }

private:
    static constexpr bool limited =
        method == Method::symplectic_euler || method == Method::velocity_verlet;

    template <class Stored>
    bool holds(const StateView<Stored, System::Dim>& view) const {
        return view.x.cols() == viewed_.x.cols() && view.v.cols() == viewed_.v.cols() &&
               view.time == static_cast<double>(viewed_.time) &&
               view.x == viewed_.x.template cast<Stored>() &&
               view.v == viewed_.v.template cast<Stored>();
    }
    Scalar largest_step();
    const Points<Scalar, System::Dim>* constraint_forces() const;
    template <class Respond>
    Report attempt(State& state, const GuardedReport<Scalar>& report, Respond& respond);
    bool admits(Scalar span, GuardedReport<Scalar>& report);
    template <class Respond>
    void name_culprits(GuardedReport<Scalar>& report, const State& failed, Respond& respond);

    const System* system_;
    Options options_;
    Stepper stepper_;
    std::optional<StepLimit<Scalar>> limit_;
    detail::LastState<State> start_;  // the last good one
    detail::EnergyAudit<System> audit_;
    double slack_;  // what is left of energy_slack
    State viewed_;  // of a StateView
};

template <class Stepper, class System>
template <class... Arguments>
Guarded<Stepper, System>::Guarded(const System& system, const Options& options,
                                  Arguments&&... arguments)
    : system_(&system),
      options_(options),
      stepper_(system, std::forward<Arguments>(arguments)...),
      slack_(options.energy_slack) {
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
    require_non_negative("Guarded", "energy_drift", options.energy_drift);
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
auto Guarded<Stepper, System>::constraint_forces() const -> const Points<Scalar, System::Dim>* {
    if constexpr (detail::is_detected_v<detail::constraint_forces_of, Stepper>) {
        return &stepper_.constraint_forces();
    } else {
        return nullptr;
    }
}

/// The report's substeps from start_, a retry with all of them in the books.
template <class Stepper, class System>
template <class Respond>
Report Guarded<Stepper, System>::attempt(State& state, const GuardedReport<Scalar>& report,
                                         Respond& respond) {
    constexpr bool responds = !std::is_same_v<std::decay_t<Respond>, detail::NoResponse>;
    const bool every = report.retries > 0;
    const auto h = static_cast<double>(report.h);
    const Index at_once = responds || every ? 1 : report.substeps;
    audit_.rewind();
    Report step;
    for (Index i = 0; i < report.substeps && step; i += at_once) {
        step = stepper_.step(state, report.h, at_once);
        if (!step) break;
        if (every) audit_.add_motion(*system_, state, constraint_forces());
        if (!responds) continue;
        respond(state);
        if (!state.finite()) return {Status::diverged, 0, 0, state.first_not_finite()};
        if (every) audit_.add_response(*system_, state, method, h);
    }
    if (step && !every) audit_.add_motion(*system_, state, constraint_forces());
    return step;
}

/// Whether the energy at the end of a frame may be what it is.
template <class Stepper, class System>
bool Guarded<Stepper, System>::admits(Scalar span, GuardedReport<Scalar>& report) {
    report.energy_rise = audit_.rise(method, static_cast<double>(report.h));
    const double moved = audit_.moved();
    const double share =
        std::min(options_.energy_slack, slack_ + options_.energy_drift * static_cast<double>(span));
    if (!(report.energy_rise <= share * moved + audit_.rounding())) return false;
    const double used = moved > 0 ? report.energy_rise / moved : 0;
    slack_ = std::min(options_.energy_slack, std::max(0.0, share - used));
    return true;
}

/// From the end of a frame that gained energy, or, if a substep failed, from the last state before.
template <class Stepper, class System>
template <class Respond>
void Guarded<Stepper, System>::name_culprits(GuardedReport<Scalar>& report, const State& failed,
                                             Respond& respond) {
    State last = failed;
    if (report.alarm == Alarm::step_failed) {
        last = start_.state();
        for (Index i = 0; i < report.substeps; ++i) {
            State next = last;
            if (!stepper_.step(next, report.h)) break;
            respond(next);
            if (!next.finite()) break;
            last = next;
        }
    }
    if (report.particle < 0) report.particle = detail::fastest_particle(*system_, last);
    report.spring = detail::fullest_spring(*system_, last);
}

template <class Stepper, class System>
template <class Respond>
auto Guarded<Stepper, System>::advance(State& state, Scalar frame, Respond&& respond)
    -> GuardedReport<Scalar> {
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
    if (!start_.is(*system_, state)) {
        start_.keep(*system_, state);
        audit_.open(*system_, state);
    }
    const double needed = std::ceil(static_cast<double>(frame) / static_cast<double>(largest));
    const bool late = needed > static_cast<double>(options_.max_substeps);
    report.substeps = late ? options_.max_substeps : std::max(Index(1), static_cast<Index>(needed));
    const Scalar span = late ? largest * static_cast<Scalar>(report.substeps) : frame;
    report.h = span / static_cast<Scalar>(report.substeps);

    for (;; ++report.retries, report.substeps *= 2, report.h /= 2) {
        const Report step = attempt(state, report, respond);
        report.status = step.status;
        report.particle = step.where;
        if (step && admits(span, report)) break;
        report.alarm = step ? Alarm::energy : Alarm::step_failed;
        if (step) report.status = Status::diverged;
        if (report.retries == options_.max_retries) {
            name_culprits(report, state, respond);
            state = start_.state();
            return report;
        }
        state = start_.state();
    }
    report.advanced = span;
    start_.keep(*system_, state);
    audit_.go_on();
    return report;
}

}  // namespace taut
