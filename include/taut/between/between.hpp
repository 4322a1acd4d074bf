// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "../integrator/energy_stable_euler.hpp"
#include "../integrator/symplectic_euler.hpp"
#include "between_steps.hpp"

namespace taut {

namespace step_detail {

/// Calls between(now) after every step, as long as all is finite.
template <class Scalar, int Dim, class Between>
class CallBetween final : public StepWatch<Scalar, Dim> {
    static_assert(std::is_invocable_v<Between&, BetweenSteps<Scalar, Dim>&>,
                  "taut::step_between: between(now) must take a BetweenSteps<Scalar, Dim>&");

public:
    explicit CallBetween(Between& between) : between_(between) {}

    /// Of the steps so far.
    const Report& report() const { return report_; }

    void see(const PlaceVectors<Scalar, Dim>&, const PlaceVectors<Scalar, Dim>&, Scalar,
             const State<Scalar, Dim>*, const Points<Scalar, Dim>*) override {}
    bool passed(const Layout<Scalar>& layout, const Buffer<int>& places,
                StateMemory<Scalar>& memory, Scalar time, Scalar ahead) override {
        if (!report_) return false;  // the stepper seeks the step that failed: not to be seen twice
        BetweenSteps<Scalar, Dim> now(layout, places, memory.planes(), time);
        bool finite = memory.finite();
        if (finite) between_(now);
        if (finite && now.changed()) {
            finite = memory.finite();
            if (ahead > 0) memory.look_ahead(ahead);
        }
        if (finite) {
            ++report_.iterations;
            return true;
        }
        report_.status = Status::diverged;
        for (Index i = 0; i < now.size() && report_.where < 0; ++i) {
            if (!detail::all_finite(now.x(i)) || !detail::all_finite(now.v(i))) report_.where = i;
        }
        return false;
    }

private:
    Between& between_;
    Report report_;
};

}  // namespace step_detail

/// Takes `count` steps of h, s, by a stepper, with between(now) after each of them, for contacts of
/// your own. It costs what the steps cost together, and what `between` does: step(state, h) one at
/// a time costs a third to a half more.
///
/// As stepper.step(state, h, count); a step that is not finite ends the call with the state as it
/// was before, but what `between` has done elsewhere remains.
/// @param stepper  SymplecticEuler or EnergyStableEuler of a SpringSystem
/// @param between  called with BetweenSteps<Scalar, Dim>&
template <template <class> class Stepper, class System, class AnyState, class Between>
Report step_between(Stepper<System>& stepper, AnyState& state, typename System::Scalar h,
                    Index count, Between&& between) {
    using Scalar = typename System::Scalar;
    constexpr Method method = Stepper<System>::method;
    static_assert(method == Method::symplectic_euler || method == Method::energy_stable_euler,
                  "taut::step_between: a SymplecticEuler or an EnergyStableEuler");
    step_detail::CallBetween<Scalar, System::Dim, std::remove_reference_t<Between>> call(between);
    const struct Watching {
        Stepper<System>& stepper;
        ~Watching() { stepper.watch(nullptr); }
    } watching{stepper};
    stepper.watch(&call);
    const Report report = stepper.step(state, h, count);
    return call.report() ? report : call.report();
}

}  // namespace taut
