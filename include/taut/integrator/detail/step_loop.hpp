// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <type_traits>

#include "../../core/concepts.hpp"
#include "../../core/detail/fits.hpp"
#include "../../network/state_view.hpp"

namespace taut::integrator_detail {

/// The frame that all steppers share: checks h and the state, takes `count` steps, and puts the
/// state back as it was when one of them fails.
template <class State>
class StepLoop {
public:
    using Scalar = typename State::Scalar;

    /// What every call refuses: a bad h, a state of the wrong size or with NaN or infinity.
    template <class System, class AnyState>
    static Report examine(const System& system, const AnyState& state, Scalar h) {
        static_assert((network_detail::require_state<State, AnyState>(), true));
        return check_state(system.size(), state, h);
    }
    /// @param size  the number of particles
    template <class AnyState>
    static Report check_state(Index size, const AnyState& state, Scalar h);

    /// @param state    the State, or a StateView, whose steps are taken on a copy
    /// @param advance  Report advance(State&): one step in place, its time excepted
    template <class System, class AnyState, class Advance>
    Report run(const System& system, AnyState& state, Scalar h, Index count, Advance&& advance) {
        Report report = examine(system, state, h);
        if (!report) return report;
        const Step step{&advance, [](void* by, State& own) -> Report {
                            return (*static_cast<std::remove_reference_t<Advance>*>(by))(own);
                        }};
        if constexpr (network_detail::is_state_view_v<AnyState>) {
            state.copy_to(copy_);
            report = examine(system, copy_, h);  // a double may be too large for a float
            if (report) report = take(copy_, h, count, step);
            if (report) state.copy_from(copy_);
        } else {
            copy_ = state;
            report = take(state, h, count, step);
            if (!report) state = copy_;
        }
        return report;
    }

private:
    /// By whatever function: what is around it is compiled once for all.
    struct Step {
        void* by;
        Report (*take)(void* by, State& state);
    };
    static Report take(State& state, Scalar h, Index count, const Step& step);

    State copy_;  // the state at the start of the call; of a view, the one that is stepped
};

template <class State>
template <class AnyState>
Report StepLoop<State>::check_state(Index size, const AnyState& state, Scalar h) {
    if (!(h > 0) || !detail::is_finite(h)) return {Status::invalid_step};
    if (!detail::fits(state, size)) return {Status::invalid_state};
    if (!state.finite()) return {Status::invalid_state, 0, 0, state.first_not_finite()};
    return {};
}

template <class State>
Report StepLoop<State>::take(State& state, Scalar h, Index count, const Step& step) {
    Report report;
    while (report && report.iterations < count) {
        const int steps = report.iterations;
        const Scalar time = state.time;
        report = step.take(step.by, state);
        if (report && !state.finite()) {
            report.status = Status::diverged;
            report.where = state.first_not_finite();
        }
        report.iterations = steps + (report ? 1 : 0);
        state.time = time + h;
    }
    return report;
}

}  // namespace taut::integrator_detail
