// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "../core/concepts.hpp"
#include "../integrator/detail/last_state.hpp"
#include "../integrator/detail/guarded_traits.hpp"
#include "../integrator/energy_stable_euler.hpp"
#include "../integrator/velocity_verlet.hpp"
#include "../method/visit.hpp"
#include "../stability/any_pose.hpp"
#include "../stability/energy_stable_limit.hpp"
#include "detail/ledger.hpp"
#include "detail/measure.hpp"
#include "detail/trim.hpp"
#include "report.hpp"

namespace taut {
namespace guard_detail {

template <class Stepper>
using constraint_forces_of = decltype(std::declval<const Stepper&>().constraint_forces());
template <class Stepper>
using method_of = decltype(Stepper::method);

}  // namespace guard_detail

/// Advances whole frames, and never explodes [T43]; to take the place of Guarded:
///
///     taut::Guard stepper(cloth);
///     stepper.advance(state, 1.0 / 60);
///
/// A frame is *tried* by a stepper, velocity Verlet unless you give another. Where a part of the
/// scene (free particles joined by springs; pins join nothing) has gained energy, its end
/// velocities are *trimmed* by damping along its springs; where that is not enough, the part's
/// frame is *taken again* by EnergyStableEuler [T42]. All limits are renewed when the system's
/// revision() has moved on.
///
/// Promised, for each part, with E its energy, K its kinetic energy about its centre of mass, W the
/// work of moving pins and outside forces, Q ≥ 0 what damping took, ρ = 4u√n·S or, where the frame
/// was taken again, 4uΣS: for every m < n
///
///     E_n ≤ E_m + 0.1 K_m + Σ(W − Q + ρ + what edits added), and no frame is refused
///
/// (finite input, true stiffness bounds, outside forces that the steps resolve). Energy must be
/// lost before it is gained back. Not promised: accuracy, what one very light particle does with
/// 0.1 K, anything inside a frame. Outside forces given as code are checked, not proved: one that
/// is too stiff is stepped finer, then damped, and named; if nothing helps, the frame is `frozen`.
/// Declare stiff ones as springs, drag or dampers.
///
/// A frame in which nothing moves, pushes or damps from outside costs one pass over the springs.
/// @tparam Stepper  SymplecticEuler, VelocityVerlet, ImplicitEuler, Bdf2, ProjectiveDynamics, one
///                  of your own (without a `method` it counts as implicit), or a function
///                  bool trial(State&, Scalar frame), or void, which takes a frame as it likes
template <class Stepper, class System = typename integrator_detail::stepped_system<Stepper>::type>
class Guard {
    using Parts = guard_detail::Parts<System>;
    using Part = typename Parts::Part;
    using Rule = guard_detail::Rule;

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = GuardOptions<Scalar>;
    using Report = GuardReport<Scalar>;
    static_assert(model_detail::is_spring_system_v<System>,
                  "taut::Guard: needs the springs of a SpringSystem");

    /// Keeps a reference: the system must outlive the guard, which makes a stepper of its own.
    /// Options out of range go to fail().
    /// @param arguments  further ones of the stepper's constructor, such as its Options
    template <class... Arguments>
    explicit Guard(const System& system, const Options& options = {}, Arguments&&... arguments)
        : system_(&system),
          options_(options),
          stepper_(made(system, options, std::forward<Arguments>(arguments)...)),
          fallback_(system, {options.threads}) {
        options.require_valid();
    }
    template <class... Arguments>
    explicit Guard(const System&&, const Options& = {}, Arguments&&...) = delete;
    /// Guards a stepper or a function of yours, as it is. Keeps references: both must outlive the
    /// guard.
    Guard(const System& system, Stepper& stepper, const Options& options = {})
        : system_(&system),
          options_(options),
          stepper_(stepper),
          fallback_(system, {options.threads}) {
        options.require_valid();
    }
    Guard(const System&&, Stepper&, const Options& = {}) = delete;

    /// Advances by `frame`, s, finite and > 0. Refused, with the state as before, is only what is
    /// not finite: invalid_step, invalid_state, diverged (a force that is not finite, or a state
    /// beyond Scalar); a system whose limits overflow has no step; and a frame that is `frozen`.
    /// Of unproved_stiffness the frame stands. What changes state or scene between frames needs no
    /// word to the guard.
    Report advance(State& state, Scalar frame);
    /// Advances an engine's own arrays by `frame`, s: copied back once a frame, and there if they
    /// are not what the last frame left.
    template <class Stored>
    Report advance(StateView<Stored, System::Dim>& view, Scalar frame) {
        return viewed_.advance(view, [&](State& state) { return advance(state, frame); });
    }

    /// The stepper of the trials, to set its constraints or its solver. A frame taken again knows
    /// nothing of constraints.
    Stepper& stepper() { return stepper_.get(); }
    /// The same, to ask it.
    const Stepper& stepper() const { return stepper_.get(); }
    /// What the guard was made with.
    const Options& options() const { return options_; }
    /// any_pose_limit as it is in force; nothing before the first frame.
    const std::optional<StepLimit<Scalar>>& limit() const { return limit_; }
    /// The books of each part in the last frame that was not refused.
    const std::vector<Part>& parts() const { return parts_.list(); }

private:
    using Held = integrator_detail::HeldStepper<Stepper>;
    static constexpr bool is_function = std::is_invocable_v<Stepper&, State&, Scalar>;
    static constexpr Method method() {
        if constexpr (detail::is_detected_v<guard_detail::method_of, Stepper>) {
            return Stepper::method;
        } else {
            return Method::implicit_euler;
        }
    }
    static constexpr bool limited = !is_function && !is_implicit(method());
    static_assert(is_function || method::Of<method()>::any_pose != method::AnyPose::no_step,
                  "taut::Guard: the stepper's method, like explicit Euler, has no limit that "
                  "holds at every pose; guard VelocityVerlet, which costs the same");
    static constexpr Rule rule = is_function                           ? Rule::ends
                                 : is_implicit(method())               ? Rule::implicit
                                 : method() == Method::velocity_verlet ? Rule::verlet
                                                                       : Rule::kick;
    static constexpr double four_u =
        2 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());

    template <class... Arguments>
    static Held made(const System& system, const Options& options, Arguments&&... arguments) {
        if constexpr (sizeof...(Arguments) == 0 && limited &&
                      std::is_constructible_v<Stepper, const System&, ExplicitOptions>) {
            return Held(std::in_place, system, ExplicitOptions{options.threads, {}});
        } else {
            return Held(std::in_place, system, std::forward<Arguments>(arguments)...);
        }
    }

    Report refuse(const State& state, Scalar frame);
    bool open(const State& state, Report& report);
    bool run_trial(State& state, const Report& report);
    void hold_pins(const State& before, State& after, Scalar h);
    void judge_trial(State& state);
    bool take_again(State& state, Report& report);
    bool steps_ahead(Index count, Scalar span, double softening, Report& report);
    bool judge_again(Report& report);
    void settle(Part& part, double excess);
    void close(State& state, Report& report);
    void measure(const State& state) {
        const Scalar h = limit_->unbounded() ? Scalar(0) : limit_->certified / 2;
        measure_(*system_, state, h, ledger_.force(), parts_);
    }
    /// What the part gained beyond its books, J; NaN where anything is not finite.
    double gain(const Part& part) const {
        const auto moved = part.now.moment - part.start.moment;
        const double fall = system_->gravity().template cast<double>().dot(moved);
        return part.now.owned - part.start.owned - fall - (part.worked - part.lost) - part.rounding;
    }
    static bool is_finite(const Part& part, double excess) {
        return part.now.finite() && std::isfinite(excess);
    }

    const System* system_;
    Options options_;
    Held stepper_;
    EnergyStableEuler<System> fallback_;
    std::optional<StepLimit<Scalar>> limit_, stable_;
    integrator_detail::LastState<State> last_;  // at the start of the frame
    Parts parts_;
    guard_detail::Ledger<System> ledger_;
    guard_detail::Measure<System> measure_;
    guard_detail::Trim<System> trim_;
    State before_, again_;  // workspace
    integrator_detail::ViewedState<State> viewed_;
};

/// By velocity Verlet.
template <class Scalar, int Dim, class... Laws>
Guard(const SpringSystem<Scalar, Dim, Laws...>&)
    -> Guard<VelocityVerlet<SpringSystem<Scalar, Dim, Laws...>>,
             SpringSystem<Scalar, Dim, Laws...>>;
/// By velocity Verlet.
template <class Scalar, int Dim, class... Laws>
Guard(const SpringSystem<Scalar, Dim, Laws...>&, const GuardOptions<Scalar>&)
    -> Guard<VelocityVerlet<SpringSystem<Scalar, Dim, Laws...>>,
             SpringSystem<Scalar, Dim, Laws...>>;
/// By velocity Verlet.
template <class Scalar, int Dim, class... Laws>
Guard(const SpringSystem<Scalar, Dim, Laws...>&, GuardOptions<Scalar>&)
    -> Guard<VelocityVerlet<SpringSystem<Scalar, Dim, Laws...>>,
             SpringSystem<Scalar, Dim, Laws...>>;

}  // namespace taut

#include "detail/guard.ipp"
