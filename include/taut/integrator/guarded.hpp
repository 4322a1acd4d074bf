// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "../core/concepts.hpp"
#include "../stability/any_pose.hpp"
#include "detail/energy_account.hpp"
#include "detail/guarded_traits.hpp"
#include "detail/last_state.hpp"
#include "detail/refinement.hpp"
#include "detail/step_loop.hpp"
#include "detail/work_meter.hpp"
#include "guarded_options.hpp"
#include "guarded_report.hpp"

namespace taut {

/// Advances whole frames by a stepper on a SpringSystem, and cannot explode unnoticed.
///
/// A frame is cut into equal substeps of at most safety·any_pose_limit [T23], renewed whenever the
/// system's revision() has moved on; implicit steppers take options.max_step. At its end the state
/// must be finite and its energy within an account that is kept for the whole run [T36]: what the
/// scene had at the start, all work done on it since, and energy_drift. Else the frame is taken
/// back to its start and tried again with twice the substeps, which later frames keep for a while.
///
/// A scene that is stuck stays cheap: after a frame that was given up each further one is attempted
/// once, every second with the limit's substeps, every fourth with twice as many and so on, until
/// one stands. With M = max_retries that is M/2 + 1 plain frames on average instead of 2^(M+1) − 1.
/// All retries are renewed when one stands and when the system's revision() has moved on.
///
/// What `ok` promises: let E = T + V be the kinetic energy of free particles and the elastic
/// energy, E_then that of any earlier accepted frame, W all work since (gravity's included, up to
/// what half a substep does), and S the largest E of late. By default C = 3.9, w = 2.6 for
/// symplectic Euler, C = 2.4, w = 2 for velocity Verlet, C = w = 1 for implicit steps [T36],
///
///     E ≤ C·E_then + w·(W + energy_slack·S + energy_drift·∫S dt + rounding).
///
/// A frame without external force, moving pin or response costs one pass over the springs more.
/// External forces are evaluated once more a substep, twice where they change faster than the
/// step resolves, and springs at moving pins once.
/// @tparam Stepper  SymplecticEuler, VelocityVerlet, ImplicitEuler, Bdf2, ProjectiveDynamics or
///                  your own, of a SpringSystem; one without a `method` counts as implicit
template <class Stepper, class System = typename integrator_detail::stepped_system<Stepper>::type>
class Guarded {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr Method method = integrator_detail::guarded_method<Stepper>();
    static_assert(method::Of<method>::any_pose != method::AnyPose::no_step,
                  "taut::Guarded: the stepper's method, like explicit Euler, has no limit that "
                  "holds at every pose; guard SymplecticEuler, which costs the same");

    using Options = GuardedOptions<Scalar>;

    /// Keeps a reference: the system must outlive the guard, which makes a stepper of its own.
    /// Options out of range go to fail().
    /// @param arguments  further ones of the stepper's constructor, such as its Options
    template <class... Arguments>
    explicit Guarded(const System& system, const Options& options = {}, Arguments&&... arguments);
    template <class... Arguments>
    explicit Guarded(const System&&, const Options& = {}, Arguments&&...) = delete;
    /// Guards a stepper of yours, as it is. Keeps references: both must outlive the guard.
    Guarded(const System& system, Stepper& stepper, const Options& options = {});
    Guarded(const System&&, Stepper&, const Options& = {}) = delete;

    /// Advances by `frame`, s, finite and > 0. No certified step (overflow) is invalid_step.
    /// What changes state or scene between frames moves the account by the energy that this adds
    /// or takes, and renews no slack.
    /// @param respond  respond(state) after every substep: contacts, for example. It may return the
    ///                 work that it does on purpose, J; other energy that it gives counts as a
    ///                 gain. It is called in attempts that are taken back, too, and must leave the
    ///                 system as it is: tear and pin between frames.
    template <class Respond = integrator_detail::NoResponse>
    GuardedReport<Scalar> advance(State& state, Scalar frame, Respond&& respond = {});
    /// Advances an engine's own arrays by `frame`, s: copied back once a frame, and there if they
    /// are not what the last frame left.
    template <class Stored, class Respond = integrator_detail::NoResponse>
    GuardedReport<Scalar> advance(StateView<Stored, System::Dim>& view, Scalar frame,
                                  Respond&& respond = {}) {
        return viewed_.advance(view, [&](State& state) { return advance(state, frame, respond); });
    }

    /// The guarded stepper, to set its solver.
    Stepper& stepper() { return stepper_.get(); }
    /// The guarded stepper, to ask it.
    const Stepper& stepper() const { return stepper_.get(); }
    /// What the guard was made with.
    const Options& options() const { return options_; }
    /// The limit in force; nothing before the first frame of an explicit stepper.
    const std::optional<StepLimit<Scalar>>& limit() const { return limit_; }

private:
    /// Whether the stepper's own inertia has a part in the energy: GraphInertia.
    static constexpr bool has_inertia =
        detail::is_detected_v<integrator_detail::added_kinetic_of, Stepper>;
    static constexpr bool limited = method::Of<method>::any_pose == method::AnyPose::limited;

    /// The stepper's own, as shares of its step.
    StepDamping damping() const {
        if constexpr (detail::is_detected_v<integrator_detail::damping_of, Stepper>) {
            return stepper().damping();
        } else {
            return {};
        }
    }
    /// Of the any-pose limit: what substeps are cut to; of a stepper with inertia, its own.
    double share() const {
        if constexpr (has_inertia) {
            return stepper().energy_share();
        } else {
            return share_of_limit(static_cast<double>(options_.safety), damping());
        }
    }
    template <class... Arguments>
    static integrator_detail::HeldStepper<Stepper> made(const System& system,
                                                        const Options& options,
                                                        Arguments&&... arguments);
    Scalar largest_step();
    const Points<Scalar, System::Dim>* constraint_forces() const;
    integrator_detail::EnergyTerms terms() const;
    integrator_detail::EnergyBooks books(const State& state) {
        auto books = integrator_detail::energy_books(*system_, state, method, meter_.pins(),
                                                     forces_, damping().linearized());
        if constexpr (has_inertia)
            books.add_kinetic(stepper().added_kinetic(state),
                              static_cast<double>(std::numeric_limits<Scalar>::epsilon()));
        return books;
    }
    Status refuse(const State& state, Scalar frame, Scalar largest, GuardedReport<Scalar>& report);
    Status open(const State& state, Scalar h);
    template <class Respond>
    Report attempt(State& state, GuardedReport<Scalar>& report, Respond& respond);
    Report steps(State& state, Scalar h, Index count) {
        const Report report = stepper().step(state, h, count);
        if constexpr (has_inertia) meter_.add(stepper().pin_work());
        return report;
    }
    void take_back(State& state) {
        state = start_.state();
        if constexpr (has_inertia) stepper().see_pins(pins_seen_);
    }
    bool admits(const State& state, Scalar span, GuardedReport<Scalar>& report);
    void settle(const State& state, int retries);
    template <class Respond>
    void name_culprits(GuardedReport<Scalar>& report, const State& failed, Respond& respond);

    const System* system_;
    Options options_;
    integrator_detail::HeldStepper<Stepper> stepper_;
    std::optional<StepLimit<Scalar>> limit_;
    integrator_detail::LastState<State> start_;  // the last good one
    integrator_detail::EnergyBooks start_books_;
    integrator_detail::EnergyAccount account_;
    integrator_detail::EnergyAccount::Frame frame_;
    integrator_detail::WorkMeter<System, method::Of<method>> meter_;
    integrator_detail::Refinement refinement_;
    State pins_seen_;                     // by a stepper with inertia, at the frame's start
    std::int64_t renewals_ = 0;           // of such a stepper, when start_books_ were made
    Points<Scalar, System::Dim> forces_;  // workspace
    integrator_detail::ViewedState<State> viewed_;
};

template <class Stepper, class System>
template <class... Arguments>
Guarded<Stepper, System>::Guarded(const System& system, const Options& options,
                                  Arguments&&... arguments)
    : system_(&system),
      options_(options),
      stepper_(made(system, options, std::forward<Arguments>(arguments)...)),
      refinement_(options.max_retries) {
    options.require_valid();
}

template <class Stepper, class System>
Guarded<Stepper, System>::Guarded(const System& system, Stepper& stepper, const Options& options)
    : system_(&system), options_(options), stepper_(stepper), refinement_(options.max_retries) {
    options.require_valid();
}

template <class Stepper, class System>
template <class... Arguments>
integrator_detail::HeldStepper<Stepper> Guarded<Stepper, System>::made(const System& system,
                                                                       const Options& options,
                                                                       Arguments&&... arguments) {
    using Held = integrator_detail::HeldStepper<Stepper>;
    constexpr bool damps = detail::is_detected_v<integrator_detail::damping_of, Stepper> &&
                           std::is_constructible_v<Stepper, const System&, ExplicitOptions>;
    if constexpr (sizeof...(Arguments) == 0 && damps) {
        return Held(std::in_place, system, ExplicitOptions{1, options.damping});
    } else {
        return Held(std::in_place, system, std::forward<Arguments>(arguments)...);
    }
}

/// 0 when no step is certified.
template <class Stepper, class System>
auto Guarded<Stepper, System>::largest_step() -> Scalar {
    if constexpr (limited) {
        const auto safety = static_cast<Scalar>(share());
        if (!limit_ || !limit_->step_for(*system_, safety)) limit_ = any_pose_limit(*system_);
        return std::min(options_.max_step, limit_->step_for(*system_, safety).value_or(Scalar(0)));
    } else {
        return options_.max_step;
    }
}

template <class Stepper, class System>
auto Guarded<Stepper, System>::constraint_forces() const -> const Points<Scalar, System::Dim>* {
    if constexpr (detail::is_detected_v<integrator_detail::constraint_forces_of, Stepper>) {
        return &stepper().constraint_forces();
    } else {
        return nullptr;
    }
}

template <class Stepper, class System>
integrator_detail::EnergyTerms Guarded<Stepper, System>::terms() const {
    return integrator_detail::EnergyTerms::of(method, share(), damping().total(),
                                              options_.energy_slack, options_.energy_drift);
}

/// The report's substeps from start_.
template <class Stepper, class System>
template <class Respond>
Report Guarded<Stepper, System>::attempt(State& state, GuardedReport<Scalar>& report,
                                         Respond& respond) {
    constexpr bool responds = !std::is_same_v<std::decay_t<Respond>, integrator_detail::NoResponse>;
    const auto h = static_cast<double>(report.h);
    meter_.start(h, std::min(1.0, 2 * (1 - share() * share())), damping().times(h));
    report.response = 0;
    if ((limited || has_inertia) && !responds && !meter_.needed(*system_, state)) {
        return steps(state, report.h, report.substeps);
    }
    Report step;
    for (Index i = 0; i < report.substeps; ++i) {
        meter_.depart(*system_, state, responds, constraint_forces() != nullptr);
        step = steps(state, report.h, 1);
        if (!step) break;
        meter_.arrive(*system_, state, constraint_forces());
        if constexpr (responds) {
            const bool count = report.retries > 0 || refinement_.stuck();
            const double before = count ? books(state).kept(method, h) : 0;
            const double claimed = integrator_detail::claimed_work(respond, state);
            meter_.add(claimed);
            if (!state.finite()) return {Status::diverged, 0, 0, state.first_not_finite()};
            if (count) report.response += books(state).kept(method, h) - before - claimed;
        }
    }
    return step;
}

/// Whether the energy at the end of a frame may be what it is.
template <class Stepper, class System>
bool Guarded<Stepper, System>::admits(const State& state, Scalar span,
                                      GuardedReport<Scalar>& report) {
    frame_ = {start_books_,
              books(state),
              method,
              static_cast<double>(report.h),
              static_cast<double>(span),
              meter_.work(),
              meter_.in_doubt(),
              meter_.unresolved(),
              meter_.thrown()};
    const auto verdict = account_.judge(frame_, terms());
    report.energy_rise = verdict.rise;
    report.work = frame_.work;
    if (verdict.admitted) return true;
    report.alarm = Alarm::energy;
    if (verdict.rise - verdict.in_doubt <= verdict.allowed) {
        report.alarm = Alarm::stiff_force;
    } else if (verdict.rise - report.response <= verdict.allowed) {
        report.alarm = Alarm::response;
    }
    return false;
}

/// The frame stands.
template <class Stepper, class System>
void Guarded<Stepper, System>::settle(const State& state, int retries) {
    account_.settle(frame_, terms());
    start_.keep(*system_, state);
    start_books_ = frame_.end;
    refinement_.settle(retries);
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
            if (!stepper().step(next, report.h)) break;
            respond(next);
            if (!next.finite()) break;
            last = next;
        }
    }
    if (report.where < 0) report.where = integrator_detail::fastest_particle(*system_, last);
    report.spring = integrator_detail::most_loaded_spring(*system_, last);
}

/// What cannot be advanced.
template <class Stepper, class System>
Status Guarded<Stepper, System>::refuse(const State& state, Scalar frame, Scalar largest,
                                        GuardedReport<Scalar>& report) {
    if (!(largest > 0)) return Status::invalid_step;
    const Report refused = integrator_detail::StepLoop<State>::check(*system_, state, frame);
    report.where = refused.where;
    return refused.status;
}

/// Opens a frame of steps of h, or shorter ones.
template <class Stepper, class System>
Status Guarded<Stepper, System>::open(const State& state, [[maybe_unused]] Scalar h) {
    bool same_books = true;
    if constexpr (has_inertia) {
        if (const Report made = stepper().renew(h); !made) return made.status;
        same_books = std::exchange(renewals_, stepper().renewals()) == stepper().renewals();
        pins_seen_ = stepper().pins_seen();
    }
    if (same_books && start_.is(*system_, state)) return Status::ok;
    const integrator_detail::EnergyBooks touched = books(state);
    if (account_.opened()) {
        account_.edit(start_books_, touched, terms());
    } else {
        account_.open(touched, terms());
    }
    start_.keep(*system_, state);
    start_books_ = touched;
    return Status::ok;
}

template <class Stepper, class System>
template <class Respond>
auto Guarded<Stepper, System>::advance(State& state, Scalar frame, Respond&& respond)
    -> GuardedReport<Scalar> {
    GuardedReport<Scalar> report;
    const Scalar largest = largest_step();
    report.status = refuse(state, frame, largest, report);
    if (!report) return report;
    const double needed = std::ceil(static_cast<double>(frame) / static_cast<double>(largest));
    const bool late = needed > static_cast<double>(options_.max_substeps);
    report.substeps = late ? options_.max_substeps : std::max(Index(1), static_cast<Index>(needed));
    const Scalar span = late ? largest * static_cast<Scalar>(report.substeps) : frame;
    refinement_.begin(system_->revision());
    report.substeps <<= refinement_.level();
    report.h = span / static_cast<Scalar>(report.substeps);
    report.status = open(state, report.h);
    if (!report) return report;

    for (;; ++report.retries, report.substeps *= 2, report.h /= 2) {
        const Report step = attempt(state, report, respond);
        report.status = step.status;
        report.where = step.where;
        if (!step) report.alarm = Alarm::step_failed;
        if (step && admits(state, span, report)) break;
        if (step) report.status = Status::diverged;
        if (!refinement_.again(report.retries)) {
            name_culprits(report, state, respond);
            take_back(state);
            refinement_.give_up();
            return report;
        }
        take_back(state);
    }
    report.advanced = span;
    settle(state, report.retries);
    return report;
}

}  // namespace taut
