// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/error.hpp"
#include "../core/status.hpp"
#include "detail/wrapper.hpp"

namespace taut {

/// Outcome of Adaptive::advance; false when a step failed at min_step, and then the state is that
/// of the last step that did not.
template <class Scalar>
struct [[nodiscard]] AdaptiveReport {
    Status status = Status::ok;
    Index steps = 0;      ///< taken
    Index rejected = 0;   ///< failed, or stretched a spring too much
    Scalar advanced = 0;  ///< s
    Scalar h = 0;         ///< that the next step will try, s
    Index where = -1;     ///< on failure: the particle that the stepper names, or −1
    Index spring = -1;    ///< the one whose change of length rejected a step last, or −1

    /// Whether status is ok.
    explicit operator bool() const { return status == Status::ok; }
};

/// Step size adaption of D. Baraff, A. Witkin, "Large steps in cloth simulation", SIGGRAPH 1998,
/// section 6, for any stepper on a SpringSystem: a step that fails, or that changes the length of a
/// spring by more than a share of its rest length, is taken back and tried with half of h; after
/// some successes in a row h doubles again.
///
/// It bounds how wrong a linearised step can be, not its order of error. Bdf2 restarts after a step
/// taken back.
/// @tparam Stepper  any of a SpringSystem
template <class Stepper, class System = typename integrator_detail::stepped_system<Stepper>::type>
class Adaptive {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    /// When to halve the step and when to double it.
    struct Options {
        Scalar max_step = static_cast<Scalar>(1.0 / 60);  ///< s, > 0; the first one tried
        Scalar min_step = static_cast<Scalar>(1e-6);      ///< s, > 0, ≤ max_step
        double max_stretch_change = 0.1;                  ///< per step, of the rest length, > 0
        int successes = 4;                                ///< in a row before h doubles, ≥ 1
    };

    /// Keeps a reference: the system must outlive this, which makes a stepper of its own. Options
    /// out of range go to fail().
    /// @param arguments  further ones of the stepper's constructor, such as its Options
    template <class... Arguments>
    explicit Adaptive(const System& system, const Options& options = {}, Arguments&&... arguments)
        : system_(&system),
          stepper_(std::in_place, system, std::forward<Arguments>(arguments)...),
          options_(options),
          h_(options.max_step) {
        require_valid(options);
    }
    template <class... Arguments>
    explicit Adaptive(const System&&, const Options& = {}, Arguments&&...) = delete;
    /// Adapts the steps of a stepper of yours. Keeps references: both must outlive this.
    Adaptive(const System& system, Stepper& stepper, const Options& options = {})
        : system_(&system), stepper_(stepper), options_(options), h_(options.max_step) {
        require_valid(options);
    }
    Adaptive(const System&&, Stepper&, const Options& = {}) = delete;

    /// Advances by `duration`, s, finite and > 0, in as many steps as it takes.
    AdaptiveReport<Scalar> advance(State& state, Scalar duration);
    /// Advances an engine's own arrays by `duration`, s: copied back once a call, and there if they
    /// are not what the last call left.
    template <class Stored>
    AdaptiveReport<Scalar> advance(StateView<Stored, System::Dim>& view, Scalar duration) {
        return viewed_.advance(view, [&](State& state) { return advance(state, duration); });
    }

    /// The stepper, to set its constraints or its solver.
    Stepper& stepper() { return stepper_.get(); }
    /// The stepper, to ask it.
    const Stepper& stepper() const { return stepper_.get(); }
    /// What this was made with.
    const Options& options() const { return options_; }

private:
    static void require_valid(const Options& options);
    /// The spring that changed its length by too much from before_ to `state`, the worst, or −1.
    /// Springs of rest length 0 have no stretch and are not judged.
    Index overstretched(const State& state) const;

    const System* system_;
    integrator_detail::HeldStepper<Stepper> stepper_;
    Options options_;
    Scalar h_;           // to try next, s
    int successes_ = 0;  // in a row
    State before_;       // the step's start
    integrator_detail::ViewedState<State> viewed_;
};

template <class Stepper, class System>
void Adaptive<Stepper, System>::require_valid(const Options& options) {
    require_positive("Adaptive", "max_step", options.max_step);
    require_positive("Adaptive", "min_step", options.min_step);
    require_positive("Adaptive", "max_stretch_change", options.max_stretch_change);
    if (options.min_step > options.max_step) {
        fail("Adaptive: min_step is ", options.min_step, "; it must be <= max_step");
    }
    if (options.successes < 1) {
        fail("Adaptive: successes is ", options.successes, "; it must be >= 1");
    }
}

template <class Stepper, class System>
Index Adaptive<Stepper, System>::overstretched(const State& state) const {
    Index found = -1;
    Index index = 0;
    auto most = static_cast<Scalar>(options_.max_stretch_change);
    system_->for_each_set([&](const auto& set) {
        for (std::size_t s = 0; s < set.a.size(); ++s, ++index) {
            if (!(set.rest_length[s] > 0)) continue;
            const Scalar l = (state.x.col(set.b[s]) - state.x.col(set.a[s])).norm();
            const Scalar was = (before_.x.col(set.b[s]) - before_.x.col(set.a[s])).norm();
            const Scalar change = std::abs(l - was) / set.rest_length[s];
            if (change > most) {
                most = change;
                found = index;
            }
        }
    });
    return found;
}

template <class Stepper, class System>
AdaptiveReport<typename System::Scalar> Adaptive<Stepper, System>::advance(State& state,
                                                                           Scalar duration) {
    AdaptiveReport<Scalar> report;
    report.h = h_;
    const Report refused = integrator_detail::StepLoop<State>::check(*system_, state, duration);
    report.status = refused.status;
    report.where = refused.where;
    if (!report) return report;
    double advanced = 0;  // in float a small step would be lost beside a long time
    while (advanced < static_cast<double>(duration)) {
        const auto left = static_cast<Scalar>(static_cast<double>(duration) - advanced);
        // A last step is cut to what is left, and a rest too small for a step goes with it.
        const bool last = left <= h_ * (1 + 16 * std::numeric_limits<Scalar>::epsilon());
        const Scalar h = last ? left : h_;
        before_ = state;
        const Report step = stepper().step(state, h);
        const Index spring = step ? overstretched(state) : Index(-1);
        if (step && spring < 0) {
            ++report.steps;
            advanced = last ? static_cast<double>(duration) : advanced + static_cast<double>(h);
            if (++successes_ >= options_.successes) {
                h_ = std::min(2 * h_, options_.max_step);
                successes_ = 0;
            }
            continue;
        }
        ++report.rejected;
        report.spring = spring;
        successes_ = 0;
        const bool bad_input = step.status == Status::invalid_state;
        if (bad_input || h <= options_.min_step) {
            // A stretch at the smallest step is the scene's own: let it pass.
            if (step) {
                ++report.steps;
                advanced = last ? static_cast<double>(duration) : advanced + static_cast<double>(h);
                continue;
            }
            report.status = step.status;
            report.where = step.where;
            break;
        }
        state = before_;
        h_ = std::max(h / 2, options_.min_step);
    }
    report.h = h_;
    report.advanced = static_cast<Scalar>(advanced);
    return report;
}

}  // namespace taut
