// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <type_traits>

#include "../../model/spring_system.hpp"
#include "plane_steps.hpp"
#include "step_loop.hpp"

namespace taut {

/// Of the explicit steppers.
struct ExplicitOptions {
    /// For the springs of a SpringSystem, with OpenMP (-fopenmp) only. The result has the same bits
    /// for any number; scenes below some thousands of particles are stepped by one.
    int threads = 1;
};

namespace detail {

/// Steps of an explicit method: springs in planes, whatever else by System::force.
template <class System>
class ExplicitSteps {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    explicit ExplicitSteps(const ExplicitOptions& options) : threads_(options.threads) {
        if (threads_ < 1) fail("ExplicitOptions: threads is ", threads_, "; it must be >= 1");
    }

    /// @param update  update(x, v, a, h): x and v, of one step, by the acceleration a = M⁻¹f(x, v);
    ///                arrays or Lanes
    template <class AnyState, class Update>
    Report run(const System& system, AnyState& state, Scalar h, Index count, const Update& update) {
        if constexpr (is_spring_system_v<System>) {
            if (!system.has_external_force()) {
                const Report report = StepLoop<State>::check(system, state, h);
                if (!report) return report;
                if (planes_.run(system, state, h, count, threads_, update)) {
                    return {Status::ok, static_cast<int>(std::max<Index>(count, 0))};
                }
                // Not finite: the steps below find out which step and which particle.
            }
        }
        return loop_.run(system, state, h, count, [&](State& own) -> Report {
            system.force(own, f_);
            update(own.x.array(), own.v.array(),
                   f_.array().rowwise() * system.inverse_mass().transpose().array(), h);
            return {};
        });
    }

private:
    struct None {};

    int threads_;
    std::conditional_t<is_spring_system_v<System>, PlaneSteps<System>, None> planes_;
    StepLoop<State> loop_;
    decltype(State::x) f_;  // force, Dim × n, N
};

}  // namespace detail
}  // namespace taut
