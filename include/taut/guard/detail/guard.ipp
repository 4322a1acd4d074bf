// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

/// What cannot be advanced; else the trial's steps.
template <class Stepper, class System>
auto Guard<Stepper, System>::refuse(const State& state, Scalar frame) -> Report {
    Report report;
    const auto check = integrator_detail::StepLoop<State>::check(*system_, state, frame);
    report.status = check.status;
    report.where = check.where;
    if (!report) return report;
    if (!limit_ || limit_->revision != system_->revision()) limit_ = any_pose_limit(*system_);
    if (!(limit_->certified > 0)) report.status = Status::invalid_step;
    const Scalar largest = limited ? std::min(options_.max_step, options_.share * limit_->certified)
                           : is_function ? std::numeric_limits<Scalar>::infinity()
                                         : options_.max_step;
    const double needed = std::ceil(static_cast<double>(frame) / static_cast<double>(largest));
    const bool late = needed > static_cast<double>(options_.max_substeps);
    report.substeps = late ? options_.max_substeps : std::max(Index(1), static_cast<Index>(needed));
    report.advanced = late ? largest * static_cast<Scalar>(report.substeps) : frame;
    report.h = report.advanced / static_cast<Scalar>(report.substeps);
    return report;
}

/// Saves the state, and has its energy measured if it is not what the last frame left.
template <class Stepper, class System>
bool Guard<Stepper, System>::open(const State& state, Report& report) {
    const bool changed = parts_.update(*system_);
    const bool touched = changed || !last_.is(*system_, state);
    ledger_.begin(*system_, state, parts_);
    if (touched) {
        last_.keep(*system_, state);
        measure(state);
        for (auto& part : parts_) part.start = part.now;
    }
    const double count = std::max(1.0, std::ceil(2 * static_cast<double>(report.advanced) /
                                                 static_cast<double>(limit_->certified)));
    for (auto& part : parts_) {
        part.rounding = four_u * std::sqrt(count) * part.start.scale;
        if (part.start.finite()) continue;
        report.status = Status::invalid_state;
        report.where = part.particle;
        last_.forget();
    }
    return bool(report);
}

/// A trial may have thrown pins anywhere.
template <class Stepper, class System>
void Guard<Stepper, System>::hold_pins(const State& before, State& after, Scalar h) {
    constexpr Scalar grain = 1024 * std::numeric_limits<Scalar>::epsilon();
    for (const Index i : parts_.pins()) {
        const typename System::Vector way = h * before.v.col(i), x = before.x.col(i) + way;
        const Scalar size = before.x.col(i).cwiseAbs().maxCoeff() + way.cwiseAbs().maxCoeff();
        const Scalar off = (after.x.col(i) - x).cwiseAbs().maxCoeff();
        if (!(off <= grain * size) || !after.x.col(i).allFinite()) after.x.col(i) = x;
        after.v.col(i) = before.v.col(i);
    }
}

/// @returns whether there is an end to judge
template <class Stepper, class System>
bool Guard<Stepper, System>::run_trial(State& state, const Report& report) {
    const Index size = system_->size();
    const auto told = [&](const State& before, Scalar h) {
        if (!taut::detail::fits(state, size)) return false;
        hold_pins(before, state, h);
        ledger_.add(*system_, before, state, h, rule, parts_);
        return true;
    };
    if constexpr (is_function) {
        if constexpr (std::is_void_v<std::invoke_result_t<Stepper&, State&, Scalar>>) {
            stepper()(state, report.advanced);
        } else if (!static_cast<bool>(stepper()(state, report.advanced))) {
            return false;
        }
        state.time = last_.state().time + report.advanced;
        return told(last_.state(), report.advanced);
    } else {
        const bool at_once = limited && !ledger_.follows(*system_);
        if (at_once) {
            return bool(stepper().step(state, report.h, report.substeps)) &&
                   told(last_.state(), report.advanced);
        }
        for (Index i = 0; i < report.substeps; ++i) {
            before_ = state;
            if (!stepper().step(state, report.h, 1) || !told(before_, report.h)) return false;
            if constexpr (taut::detail::is_detected_v<guard_detail::constraint_forces_of, Stepper>)
                ledger_.add_held(stepper().constraint_forces(), before_, state, parts_);
        }
        return true;
    }
}

/// Trims what can be trimmed, and settles every part but those that must be taken again.
template <class Stepper, class System>
void Guard<Stepper, System>::judge_trial(State& state) {
    measure(state);
    bool trims = false;
    const auto excess = [&](const Part& part) {
        const double a = part.credit + gain(part), K = part.now.kinetic;
        const bool can = part.paused == 0 && is_finite(part, a) && a > 1e-12 * K && a <= K / 4;
        return can ? a * (1 + 1e-6) : 0.0;
    };
    for (auto& part : parts_) {
        part.taken = excess(part) > 0 ? Taken::trimmed : Taken::tried;
        trims = trims || part.taken == Taken::trimmed;
    }
    if (trims) {
        const auto h = static_cast<double>(limit_->certified);
        trim_(*system_, state, h * h / 4, parts_, excess);
        measure(state);
    }
    for (auto& part : parts_) {
        const double a = part.credit + gain(part);
        if (part.paused > 0 || !is_finite(part, a) || a > 1e-12 * part.now.kinetic) {
            part.taken = Taken::again;
        } else {
            settle(part, a);
        }
    }
}

/// The part stands as it is now.
template <class Stepper, class System>
void Guard<Stepper, System>::settle(Part& part, double excess) {
    part.end = part.now;
    part.kinetic = part.now.kinetic;
    part.work = part.worked;
    part.loss = part.lost;
    part.credit = std::max(std::min(excess, 0.0), -0.1 * part.kinetic);
}

/// n steps of EnergyStableEuler from the frame's start, on all parts.
template <class Stepper, class System>
bool Guard<Stepper, System>::steps_ahead(Index count, Scalar span, double softening,
                                         Report& report) {
    const Scalar h = span / static_cast<Scalar>(count);
    again_ = last_.state();
    ledger_.begin(*system_, again_, parts_);
    for (auto& part : parts_)
        if (part.taken == Taken::again) part.rounding = 0;
    for (Index i = 0; i < count; ++i) {
        before_ = again_;
        measure(again_);
        for (auto& part : parts_)
            if (part.taken == Taken::again) part.rounding += four_u * part.now.scale;
        const auto step = fallback_.step(again_, h, 1);
        report.status = step.status;
        report.where = step.where;
        if (!step) return false;
        if (softening > 0) ledger_.soften(*system_, before_, again_, h, softening);
        ledger_.add(*system_, before_, again_, h, Rule::ahead, parts_);
    }
    measure(again_);
    return judge_again(report);
}

/// Whether the parts taken again are finite and kept their books.
template <class Stepper, class System>
bool Guard<Stepper, System>::judge_again(Report& report) {
    for (auto& part : parts_) {
        if (part.taken != Taken::again) continue;
        const double a = gain(part);
        const bool finite = is_finite(part, a);
        if (finite && a <= 1e-12 * part.now.kinetic) continue;
        report.status = !finite                                ? Status::diverged
                        : ledger_.untrue_spring() >= 0         ? Status::unproved_stiffness
                        : system_->external_forces().is_code() ? Status::frozen
                                                               : Status::ok;
        if (!finite) report.where = part.particle;
        if (report.status != Status::ok) return false;
    }
    return true;
}

/// @returns whether the frame stands
template <class Stepper, class System>
bool Guard<Stepper, System>::take_again(State& state, Report& report) {
    const auto is_again = [](const Part& part) { return part.taken == Taken::again; };
    report.again = std::count_if(parts_.begin(), parts_.end(), is_again);
    if (report.again == 0) return true;
    if (!stable_ || stable_->revision != system_->revision())
        stable_ = energy_stable_limit(*system_);
    const double needed =
        std::ceil(static_cast<double>(report.advanced) / static_cast<double>(stable_->certified));
    auto count = static_cast<Index>(std::max(1.0, std::min(needed, 1e9)));
    if (report.advanced / static_cast<Scalar>(count) > stable_->certified) ++count;
    const bool code = system_->external_forces().is_code();
    for (int attempt = 0;; ++attempt) {
        const double softening = attempt < 3 ? 0 : 1 << (attempt - 3);
        const Index steps = count << std::min(attempt, 2);
        if (steps_ahead(steps, report.advanced, softening, report)) break;
        const bool law = report.status == Status::unproved_stiffness;
        if (law) {
            report.law = ledger_.untrue_law();
            report.spring = ledger_.untrue_spring();
            break;
        }
        if (!code) return false;
        report.force = ledger_.stiffest_force(*system_, last_.state(), again_);
        if (attempt == 9) return false;
    }
    if (report.again == report.parts) {
        state = again_;
    } else {
        for (Index i = 0; i < system_->size(); ++i) {
            if (parts_.of(i) < 0 || !is_again(parts_[parts_.of(i)])) continue;
            state.x.col(i) = again_.x.col(i);
            state.v.col(i) = again_.v.col(i);
        }
    }
    for (auto& part : parts_)
        if (is_again(part)) settle(part, part.credit);  // R moves with E
    return true;
}

template <class Stepper, class System>
void Guard<Stepper, System>::close(State& state, Report& report) {
    double worst = -1;
    for (auto& part : parts_) {
        const bool paused = part.paused > 0;
        if (paused) --part.paused;
        if (part.taken != Taken::again) {
            part.streak = 0;
            part.pause = 2;
        } else if (!paused && ++part.streak >= 3) {
            part.paused = part.pause;
            part.pause = std::min(64, 2 * part.pause);
        }
        part.start = part.end;
        part.energy =
            part.end.owned - system_->gravity().template cast<double>().dot(part.end.moment);
        report.energy += part.energy;
        report.kinetic += part.kinetic;
        report.work += part.work;
        report.loss += part.loss;
        report.credit += part.credit;
        report.rounding += part.rounding;
        report.trimmed += part.taken == Taken::trimmed;
        const double rank = static_cast<int>(part.taken) + part.kinetic / (1 + part.kinetic);
        if (!(rank > worst)) continue;
        worst = rank;
        report.taken = part.taken;
        report.particle = part.particle;
    }
    last_.keep(*system_, state);
}

template <class Stepper, class System>
auto Guard<Stepper, System>::advance(State& state, Scalar frame) -> Report {
    Report report = refuse(state, frame);
    bool stands = report && open(state, report);
    if (stands) {
        report.parts = static_cast<Index>(parts_.list().size());
        bool paused = true;
        for (auto& part : parts_) {
            part.taken = Taken::again;
            paused = paused && part.paused > 0;
        }
        if (!paused && run_trial(state, report)) judge_trial(state);
        stands = take_again(state, report);
        if (!stands) state = last_.state();
    }
    if (stands) {
        close(state, report);
    } else {
        report.advanced = 0;
    }
    return report;
}

}  // namespace taut
