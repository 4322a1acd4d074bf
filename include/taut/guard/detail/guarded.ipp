// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

template <class Stepper, class System>
void Guarded<Stepper, System>::renew(bool touch) {
    const bool first = !proved_limit_;
    const bool edited = first || proved_limit_->revision != system_->revision();
    if (edited) frames_to_sharpen_ = first ? 1 : 60;
    if (frames_to_sharpen_ > 0 && --frames_to_sharpen_ == 0) {
        std::tie(any_pose_limit_, proved_limit_) = sharp_limits(*system_);
    } else if (edited) {
        any_pose_limit_ = any_pose_limit(*system_);
        proved_limit_ = energy_limit(*system_);  // last: its revision stands for both
    }
    parts_.update(*system_, touch);
    proved_step_ = proved_limit_->certified;
}

/// The longest, s.
template <class Stepper, class System>
auto Guarded<Stepper, System>::trial_step() const -> Scalar {
    Scalar h = std::numeric_limits<Scalar>::infinity();
    if constexpr (any_pose == method::AnyPose::limited) {
        h = Scalar(0.95) * any_pose_limit_->certified;
        if (proved_step_ < proved_limit_->certified) h *= proved_step_ / proved_limit_->certified;
    } else if constexpr (any_pose == method::AnyPose::proved) {
        h = proved_step_;
    }
    return (std::min)(options_.max_step, h);
}

/// Measures what a frame begins with, and refuses what cannot be advanced.
template <class Stepper, class System>
Status Guarded<Stepper, System>::open(const State& state, Scalar frame, Scalar longest,
                                      GuardedReport<Scalar>& report) {
    const Report checked = integrator_detail::StepLoop<State>::examine(*system_, state, frame);
    report.where = checked.where;
    if (!checked) return checked.status;
    if (!(longest > 0) || !(proved_step_ > 0)) return Status::invalid_step;
    shortest_ = (std::min)(frame, proved_step_);
    edited_ = !last_.is(*system_, state) || !held_as_before();
    if (!edited_ && end_.size() == parts_.count()) {
        begin_ = end_;
    } else {
        measure(state, begin_);
    }
    last_.forget();
    for (std::size_t p = 0; p < parts_.count(); ++p) {
        if (begin_[p].finite()) continue;
        report.where = parts_[p].first;
        return Status::invalid_state;
    }
    for (std::size_t p = 0; p < parts_.count(); ++p) {
        // An edit may have stopped what had earned it.
        parts_[p].balance = (std::max)(parts_[p].balance, -0.1 * begin_[p].kinetic);
    }
    blamed_ = nullptr;
    too_stiff_ = false;
    start_ = state;
    parts_.keep();
    booked_.assign(parts_.count(), 0);
    slack_.assign(parts_.count(), 0);
    taken_.assign(parts_.count(), Taken::again);
    return Status::ok;
}

template <class Stepper, class System>
auto Guarded<Stepper, System>::cut(Scalar span, Scalar longest, Index most) -> Frame {
    const double steps = std::ceil(static_cast<double>(span) / static_cast<double>(longest));
    const Index count = std::clamp(static_cast<Index>(steps), Index(1), most);
    return {span / static_cast<Scalar>(count), count};
}

/// @param by    what takes the steps
/// @param take  bool take(state, h, count): steps by it
/// @returns whether all steps were taken, to a finite state
template <class Stepper, class System>
template <class By, class Take, class Respond>
bool Guarded<Stepper, System>::run(State& state, Frame frame, Kind kind, By& by, Take&& take,
                                   Respond& respond) {
    constexpr bool touches = guard_detail::is_contacts_v<Respond>;
    constexpr bool responds =
        !touches && !std::is_same_v<std::decay_t<Respond>, guard_detail::NoResponse>;
    constexpr bool held = detail::is_detected_v<guard_detail::constraint_forces_of, Stepper>;
    constexpr bool shows = detail::is_detected_v<integrator_detail::watch_of, By>;
    const bool seen = work_.start(*system_, state, parts_, frame.h, kind);
    const bool stepwise = responds || held || (seen && !shows);
    const Index at_once = stepwise ? 1 : frame.steps;
    if (stepwise && !shows) work_.see(state);
    step_detail::StepWatch<Scalar, System::Dim>* watch = seen ? &work_ : nullptr;
    if constexpr (touches) {
        static_assert(shows && !held,
                      "taut::Guarded: contacts need a trial by VelocityVerlet, SymplecticEuler or "
                      "EnergyStableEuler");
        respond.begin(frame.h, frame.steps, std::exchange(watch, &respond));
    }
    const integrator_detail::Watching watching(by, watch);
    for (Index done = 0; done < frame.steps; done += at_once) {
        if (shows && stepwise && done > 0) work_.repeat();  // where a call of its own begins
        if (!take(state, frame.h, at_once)) return false;
        if (!detail::fits(state, system_->size()) || !state.finite()) return false;
        if constexpr (held) {
            if (kind != Kind::ahead) work_.add_held(stepper().constraint_forces(), state);
        }
        if (stepwise && !shows) work_.see(state);
        work_.add_constant(state);
        if constexpr (responds) {
            touched_ = state;
            respond(state);
            const bool fits = detail::fits(state, system_->size());
            if (!fits || !state.finite()) {
                blamed_ = "respond";
                where_ = fits ? state.first_not_finite() : -1;
                return false;
            }
            for (Index i = 0; i < system_->size(); ++i) {
                if (!system_->is_pinned(i)) continue;
                state.x.col(i) = touched_.x.col(i);
                state.v.col(i) = touched_.v.col(i);
            }
            if (state.x == touched_.x && state.v == touched_.v) continue;
            measure(touched_, before_);
            measure(state, after_);
            work_.add_change(before_, after_, state);
        }
    }
    work_.add_swing(state);
    if constexpr (touches) work_.add_each(respond.end());
    return stepwise || !seen || work_.seen() == frame.steps + 1;
}

template <class Stepper, class System>
template <class Respond>
bool Guarded<Stepper, System>::try_frame(State& state, Frame frame, Respond& respond) {
    const auto take = [&](State& own, Scalar h, Index count) {
        if constexpr (detail::is_detected_v<guard_detail::method_of, Stepper>) {
            return guard_detail::take_steps(stepper(), own, h, count);
        } else {
            // Pins and time are not the caller's to move.
            touched_ = own;
            const bool taken = guard_detail::take_steps(stepper(), own, h, count);
            if (!taken || !detail::fits(own, system_->size())) return false;
            for (Index i = 0; i < system_->size(); ++i) {
                if (!system_->is_pinned(i)) continue;
                own.v.col(i) = touched_.v.col(i);
                own.x.col(i) = touched_.x.col(i) + static_cast<Scalar>(count) * h * own.v.col(i);
            }
            own.time = touched_.time + static_cast<Scalar>(count) * h;
            return true;
        }
    };
    constexpr Kind kind = any_pose == method::AnyPose::limited  ? Kind::at_both_ends
                          : any_pose == method::AnyPose::proved ? Kind::ahead
                                                                : Kind::at_the_end;
    return run(state, frame, kind, stepper(), take, respond);
}

/// a of a part, J: what it has gained beyond its books by the end of its trial.
template <class Stepper, class System>
double Guarded<Stepper, System>::gain(std::size_t part) const {
    return parts_[part].balance + end_[part].total - begin_[part].total - work_[part].booked;
}

template <class Stepper, class System>
bool Guarded<Stepper, System>::holds(std::size_t part) const {
    return end_[part].finite() && gain(part) <= slack_[part] + 1e-12 * end_[part].kinetic;
}

/// Whether every step of the last run follows the forces that are given as code.
template <class Stepper, class System>
bool Guarded<Stepper, System>::resolved(std::size_t part) const {
    return work_[part].jump <= slack_[part];
}

/// Says of every part what becomes of its trial, and trims what gained a little.
template <class Stepper, class System>
void Guarded<Stepper, System>::judge(State& state, bool tried) {
    if (!tried) return;
    measure(state, end_);
    gains_.assign(parts_.count(), {});
    for (std::size_t p = 0; p < parts_.count(); ++p) {
        const bool follows = resolved(p);
        too_stiff_ = too_stiff_ || !follows;
        slack_[p] += work_[p].swing;
        if (parts_[p].skip > 0 || !follows) continue;
        const double quarter = end_[p].kinetic / 4;
        if (holds(p)) {
            taken_[p] = Taken::tried;
        } else if (end_[p].finite() && gain(p) - slack_[p] <= quarter) {
            taken_[p] = Taken::trimmed;
            gains_[p].left = (std::min)(gain(p), quarter);
            gains_[p].speed = end_[p].speed;
        }
    }
    if (any(Taken::trimmed)) {
        trim(*system_, state, parts_, static_cast<double>(any_pose_limit_->certified), gains_,
             touched_.v);
        measure(state, end_);
    }
    for (std::size_t p = 0; p < parts_.count(); ++p) {
        if (taken_[p] == Taken::trimmed && !holds(p)) taken_[p] = Taken::again;
        if (taken_[p] == Taken::again) continue;
        booked_[p] = work_[p].booked;
        parts_[p].balance = (std::max)(gain(p), -0.1 * end_[p].kinetic - work_[p].swing);
        parts_[p].again = 0;
        parts_[p].next_skip = 2;
    }
}

/// @returns whether what the user gives was finite
template <class Stepper, class System>
template <class Respond>
bool Guarded<Stepper, System>::take_again(State& state, Scalar span, bool tried,
                                          GuardedReport<Scalar>& report, Respond& respond) {
    const auto take = [&](State& own, Scalar h, Index count) {
        const Report stepped = proved_.step(own, h, count);
        report.where = stepped.where;
        return bool(stepped);
    };
    for (int halvings = 0; halvings <= most_halvings; ++halvings) {
        too_stiff_ = too_stiff_ || halvings > 0;
        if (!(proved_step_ > 0)) return false;
        const Index steps = cut(span, proved_step_).steps << halvings;
        const Frame frame{span / static_cast<Scalar>(steps), steps};
        again_ = start_;
        if (!run(again_, frame, Kind::ahead, proved_, take, respond)) {
            if constexpr (guard_detail::is_self_contact_v<Respond>) {
                if (respond.wants_another()) {
                    proved_step_ = respond.longest();
                    --halvings;
                    continue;
                }
            }
            if (blamed_ || !stiff_by_code()) return false;
            if (halvings == most_halvings)
                std::replace(taken_.begin(), taken_.end(), Taken::again, Taken::frozen);
            continue;
        }
        for (Index i = 0; i < system_->size(); ++i) {
            if (taken_of(i, tried) != Taken::again) continue;
            state.x.col(i) = again_.x.col(i);
            state.v.col(i) = again_.v.col(i);
        }
        if constexpr (guard_detail::is_contacts_v<Respond>) {
            respond.choose([&](Index i) { return !tried || taken_of(i, tried) == Taken::again; });
        }
        measure(state, end_);
        bool stiff = false;
        for (std::size_t p = 0; p < parts_.count(); ++p) {
            if (taken_[p] != Taken::again) continue;
            if (!end_[p].finite() && !stiff_by_code()) return false;
            slack_[p] = 4 * unit * static_cast<double>(frame.steps) *
                        (std::max)(begin_[p].terms, end_[p].terms);
            stiff = stiff || !resolved(p);
        }
        if (!stiff) break;
    }
    for (std::size_t p = 0; p < parts_.count(); ++p) {
        if (taken_[p] == Taken::again) settle_again(p, report);
    }
    freeze(state, respond);
    return true;
}

/// Whether forces given as code can be why a step was not finite: they were, where it began.
template <class Stepper, class System>
bool Guarded<Stepper, System>::stiff_by_code() {
    if (!work_.code()) return false;
    system_->external_force(start_, touched_.v);
    return detail::all_finite(touched_.v);
}

/// A part that was taken again for the last time in this frame.
template <class Stepper, class System>
void Guarded<Stepper, System>::settle_again(std::size_t part, GuardedReport<Scalar>& report) {
    guard_detail::Part& own = parts_[part];
    booked_[part] = work_[part].booked;
    if (!end_[part].finite() || !resolved(part)) taken_[part] = Taken::frozen;
    const double rise = end_[part].total - begin_[part].total - booked_[part];
    if (taken_[part] == Taken::again) {
        // [T42] has the work of forces as they were at the start of each step.
        if (rise + work_[part].turn > slack_[part]) report.spring = strongest_spring(part);
        // What it lost pays what it owes, and earns nothing but what code forces hold back.
        const double held = work_[part].swing;
        own.balance = (std::max)({own.balance + rise, (std::min)(own.balance, 0.0) - held,
                                  -0.1 * end_[part].kinetic - held});
        slack_[part] += held;
    }
    if (own.skip > 0) {
        --own.skip;
    } else if (++own.again >= 3) {
        own.skip = own.next_skip;
        own.next_skip = (std::min)(2 * own.next_skip, 64);
    }
}

/// Stops the frozen parts where the frame began: what then moves their energy is pins.
template <class Stepper, class System>
template <class Respond>
void Guarded<Stepper, System>::freeze(State& state, [[maybe_unused]] Respond& respond) {
    if (!any(Taken::frozen)) return;
    for (Index i = 0; i < system_->size(); ++i) {
        if (taken_of(i, true) != Taken::frozen) continue;
        state.x.col(i) = start_.x.col(i);
        state.v.col(i).setZero();
        if constexpr (guard_detail::is_contacts_v<Respond>) respond.stay(i, start_.x.col(i));
    }
    measure(state, end_);
    for (std::size_t p = 0; p < parts_.count(); ++p) {
        if (taken_[p] != Taken::frozen) continue;
        booked_[p] = end_[p].total - (begin_[p].total - begin_[p].speed / 2);
        parts_[p].balance = (std::max)(0.0, parts_[p].balance - begin_[p].speed / 2);
    }
}

/// The spring of a part that exceeds its law's bound most, or −1; it counts the laws in their
/// order. At the ends of the frame that was taken again.
template <class Stepper, class System>
Index Guarded<Stepper, System>::strongest_spring(std::size_t part) const {
    Index found = -1, index = -1;
    Scalar most = 1 + 64 * std::numeric_limits<Scalar>::epsilon();
    system_->visit_springs([&](const auto& spring) {
        ++index;
        if (parts_.of(spring.a, spring.b) != static_cast<Index>(part)) return;
        for (const State* state : {&start_, &again_}) {
            const typename System::Vector dx = state->x.col(spring.b) - state->x.col(spring.a);
            const Scalar l = spring_length(dx);
            const Scalar k = (std::max)(spring.tension_slope(l), spring.tension(l) / l);
            if (!(k > most * spring.stiffness_bound())) continue;
            most = k / spring.stiffness_bound();
            found = index;
        }
    });
    return found;
}

/// Sums up the frame, whose end is `state`.
template <class Stepper, class System>
void Guarded<Stepper, System>::close(const State& state, GuardedReport<Scalar>& report) {
    last_.keep(*system_, state);
    held_last_.clear();
    if (held_) held_last_ = *held_;
    report.parts = static_cast<Index>(parts_.count());
    for (std::size_t p = 0; p < parts_.count(); ++p) {
        report.trimmed += taken_[p] == Taken::trimmed;
        report.again += taken_[p] == Taken::again;
        report.frozen += taken_[p] == Taken::frozen;
        report.energy += end_[p].total;
        report.work += booked_[p];
        report.balance += parts_[p].balance;
        report.slack += slack_[p];
        const double hidden = slack_[p] - work_[p].swing;
        report.blind =
            report.blind || (hidden > end_[p].kinetic / 100 && hidden > 0.5e-6 * end_[p].mass);
        if (taken_[p] <= report.taken) continue;
        report.taken = taken_[p];
        report.where = parts_[p].first;
    }
    if (report.frozen > 0) report.status = Status::frozen;
    if (report.frozen > 0 || too_stiff_) report.force = force_name();
}

/// What set the forces from outside; null without them.
template <class Stepper, class System>
const char* Guarded<Stepper, System>::force_name() const {
    const auto& forces = system_->external_forces();
    if (forces.whole) return "set_external_force";
    if (forces.outside) return forces.outside->name();
    return forces.constant.cols() > 0 ? "set_constant_force" : nullptr;
}

template <class Stepper, class System>
template <class Respond>
auto Guarded<Stepper, System>::advance(State& state, Scalar frame, Respond&& respond)
    -> GuardedReport<Scalar> {
    GuardedReport<Scalar> report;
    renew(guard_detail::is_self_contact_v<Respond>);
    held_ = nullptr;
    if constexpr (guard_detail::is_contacts_v<Respond>) {
        if (&respond.system() != system_)
            fail("Guarded::advance: the contacts are of another system");
        held_ = &respond.open(state);
    }
    if constexpr (guard_detail::is_self_contact_v<Respond>)
        proved_step_ = respond.longest(proved_limit_->certified);
    const Scalar longest = trial_step();
    report.status = open(state, frame, longest, report);
    if (!report) return report;
    // Of what is taken again as many steps as an Index can count.
    const Scalar span = (std::min)({frame, longest * static_cast<Scalar>(options_.max_substeps),
                                    proved_step_ * Scalar(1 << 28)});
    const Frame trial = cut(span, longest, options_.max_substeps);
    report.substeps = trial.steps;
    report.h = trial.h;
    const double proved = std::ceil(static_cast<double>(span / proved_step_));
    for (std::size_t p = 0; p < parts_.count(); ++p) {
        slack_[p] = 4 * unit * std::sqrt((std::max)(1.0, proved)) * begin_[p].terms;
        // An edit may have taken with it what would have paid.
        if (edited_) parts_[p].balance = (std::min)(parts_[p].balance, slack_[p]);
    }

    struct Undo {  // of what is refused, or thrown out of
        Guarded& guard;
        State& state;
        bool wanted = true;
        ~Undo() {
            if (!wanted) return;
            state = guard.start_;
            guard.parts_.restore();
        }
    } undo{*this, state};
    const bool tried = !parts_.all_skip() && try_frame(state, trial, respond);
    judge(state, tried);
    if (!tried) state = start_;
    if ((!tried || any(Taken::again)) && !take_again(state, span, tried, report, respond)) {
        report.status = Status::diverged;
        report.force = blamed_ ? blamed_ : force_name();
        if (blamed_) report.where = where_;
        for (std::size_t p = 0; p < parts_.count() && report.spring < 0 && !blamed_; ++p) {
            if (taken_[p] == Taken::again) report.spring = strongest_spring(p);
        }
        return report;
    }
    if constexpr (guard_detail::is_contacts_v<Respond>) respond.settle(state);
    state.time = start_.time + span;
    report.advanced = span;
    close(state, report);
    undo.wanted = false;
    return report;
}

}  // namespace taut
