// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "../../core/concepts.hpp"

namespace taut::detail {

/// The frame that all steppers share: checks h and the state, takes `count` steps, and puts the
/// state back as it was when one of them fails.
template <class State>
class StepLoop {
public:
    using Scalar = typename State::Scalar;

    /// What every call refuses: a bad h, a state of the wrong size or with NaN or infinity.
    template <class System>
    static Report check(const System& system, const State& state, Scalar h) {
        if (!(h > 0) || !std::isfinite(h)) return {Status::invalid_step};
        if (state.x.cols() != system.size() || state.v.cols() != system.size()) {
            return {Status::invalid_state};
        }
        if (!state.finite()) return {Status::invalid_state, 0, 0, state.first_not_finite()};
        return {};
    }

    /// @param advance  Report advance(): one step of `state` in place, its time excepted
    template <class System, class Advance>
    Report run(const System& system, State& state, Scalar h, Index count, Advance&& advance) {
        Report report = check(system, state, h);
        if (!report) return report;
        backup_ = state;
        while (report && report.iterations < count) {
            const int steps = report.iterations;
            const Scalar time = state.time;
            report = advance();
            if (report && !state.finite()) {
                report.status = Status::diverged;
                report.where = state.first_not_finite();
            }
            report.iterations = steps + (report ? 1 : 0);
            state.time = time + h;
        }
        if (!report) state = backup_;
        return report;
    }

private:
    State backup_;  // the state at the start of the call
};

}  // namespace taut::detail
