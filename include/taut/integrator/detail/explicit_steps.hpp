// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <type_traits>

#include "../../model/spring_system.hpp"
#include "../explicit_options.hpp"
#include "../sweep/sweep.hpp"
#include "step_loop.hpp"

namespace taut {

namespace integrator_detail {

/// Steps of an explicit method: springs by a sweep, whatever else by System::force.
template <class System>
class ExplicitSteps {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    explicit ExplicitSteps(const ExplicitOptions& options) : options_(options) {
        if (options.threads < 1)
            fail("ExplicitOptions: threads is ", options.threads, "; it must be >= 1");
        require_step_damping<System>(options.damping);
    }
    const StepDamping& damping() const { return options_.damping; }

    /// @param update  update(x, v, a, h): x and v, of one step, by the acceleration a = M⁻¹f(x, v);
    ///                arrays or registers. A method that needs two accelerations cannot use this
    template <class AnyState, class Update>
    Report run(const System& system, AnyState& state, Scalar h, Index count, const Update& update) {
        [[maybe_unused]] const auto added = options_.damping.times(static_cast<double>(h));
        if constexpr (model_detail::is_spring_system_v<System>) {
            if (!system.has_external_force()) {
                const Report report = StepLoop<State>::check(system, state, h);
                if (!report) return report;
                if (sweep_.run(system, state, h, count, options_.threads, added, update)) {
                    return {Status::ok, static_cast<int>(std::max<Index>(count, 0))};
                }
                // Not finite: the steps below find out which step and which particle.
            }
        }
        return loop_.run(system, state, h, count, [&](State& own) -> Report {
            if constexpr (model_detail::is_spring_system_v<System>) {
                system.force(own, f_, added);
            } else {
                system.force(own, f_);
            }
            update(own.x.array(), own.v.array(),
                   f_.array().rowwise() * system.inverse_mass().transpose().array(), h);
            return {};
        });
    }

private:
    struct None {};

    ExplicitOptions options_;
    std::conditional_t<model_detail::is_spring_system_v<System>, sweep::Sweep<System>, None> sweep_;
    StepLoop<State> loop_;
    decltype(State::x) f_;  // force, Dim × n, N
};

}  // namespace integrator_detail
}  // namespace taut
