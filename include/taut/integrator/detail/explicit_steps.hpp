// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <utility>

#include "../../network/spring_system.hpp"
#include "../explicit_options.hpp"
#include "../../step/sweep.hpp"
#include "step_loop.hpp"

namespace taut {

namespace integrator_detail {

/// v⁺ = v + h a, then x⁺ = x + h v⁺.
struct KickAndDrift {
    template <class X, class V, class A, class Step>
    EIGEN_ALWAYS_INLINE void operator()(X&& x, V&& v, const A& a, const Step& h) const {
        v += h * a;
        x += h * v;
    }
};

/// x⁺ = x + h v, then v⁺ = v + h a.
struct DriftAndKick {
    template <class X, class V, class A, class Step>
    EIGEN_ALWAYS_INLINE void operator()(X&& x, V&& v, const A& a, const Step& h) const {
        x += h * v;
        v += h * a;
    }
};

inline int checked_threads(const ExplicitOptions& options) {
    if (options.threads < 1)
        fail("ExplicitOptions: threads is ", options.threads, "; it must be >= 1");
    return options.threads;
}

/// Steps of an explicit method by its force, System::force; those of a SpringSystem are below.
template <class System, class = void>
class ExplicitSteps {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    explicit ExplicitSteps(const ExplicitOptions& options) { checked_threads(options); }

    /// Steps of a method that needs one acceleration.
    /// @param update  update(x, v, a, h): x and v, of one step, by the acceleration a = M⁻¹f(x, v);
    ///                arrays or registers
    template <class AnyState, class Update>
    Report run(const System& system, AnyState& state, Scalar h, Index count, const Update& update) {
        return loop_.run(system, state, h, count, [&](State& own) -> Report {
            system.force(own, f_);
            update(own.x.array(), own.v.array(), acceleration(system), h);
            return {};
        });
    }
    /// Steps of velocity Verlet. @param go_on  whether state and system are as the last call left
    /// them
    template <class AnyState>
    Report run_verlet(const System& system, AnyState& state, Scalar h, Index count, bool go_on) {
        return loop_.run(system, state, h, count, [&](State& own) -> Report {
            if (!std::exchange(go_on, true)) system.force(own, f_);
            own.v.array() += h / 2 * acceleration(system);
            own.x += h * own.v;
            own.time += h;
            if (!own.finite()) return {};  // nobody's force is asked there
            system.force(own, f_);
            own.v.array() += h / 2 * acceleration(system);
            return {};
        });
    }

private:
    /// M⁻¹f, Dim × n, m/s².
    auto acceleration(const System& system) const {
        return f_.array().rowwise() * system.inverse_mass().transpose().array();
    }

    StepLoop<State> loop_;
    decltype(State::x) f_;  // force, Dim × n, N
};

/// Steps of a SpringSystem, by its sweep.
template <class System>
class ExplicitSteps<System, std::enable_if_t<network_detail::is_spring_system_v<System>>> {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    explicit ExplicitSteps(const ExplicitOptions& options) : threads_(checked_threads(options)) {}

    /// Shows steps to that; null ends it.
    void watch(step_detail::StepWatch<Scalar, System::Dim>* by) { sweep_.watch(by); }
    /// As above.
    template <class AnyState, class Update>
    Report run(const System& system, AnyState& state, Scalar h, Index count, const Update& update) {
        return sweep_all(system, state, h, count, [&](auto& own, Index steps) {
            return sweep_.run(system, own, h, steps, threads_, update);
        });
    }
    /// The same with the springs one step ahead [T42].
    template <class AnyState, class Update>
    Report run_ahead(const System& system, AnyState& state, Scalar h, Index count,
                     const Update& update) {
        return sweep_all(system, state, h, count, [&](auto& own, Index steps) {
            return sweep_.run_ahead(system, own, h, steps, threads_, update);
        });
    }
    /// As above.
    template <class AnyState>
    Report run_verlet(const System& system, AnyState& state, Scalar h, Index count, bool go_on) {
        return sweep_all(system, state, h, count, [&](auto& own, Index steps) {
            const bool swept = sweep_.run_verlet(system, own, h, steps, threads_, go_on);
            go_on = go_on || swept;
            return swept;
        });
    }
    /// The same as run, by accelerations that are corrected all together.
    /// @tparam Ahead   and correct: as of Sweep::run_corrected
    template <bool Ahead, class AnyState, class Correct>
    Report run_corrected(const System& system, AnyState& state, Scalar h, Index count,
                         const Correct& correct) {
        return sweep_all(system, state, h, count, [&](auto& own, Index steps) {
            return sweep_.template run_corrected<Ahead>(system, own, h, steps, threads_, correct);
        });
    }

private:
    /// @param sweep  bool sweep(state, steps): all of them at once; where not all is finite, the
    ///               state is not touched
    template <class AnyState, class Steps>
    Report sweep_all(const System& system, AnyState& state, Scalar h, Index count,
                     const Steps& sweep) {
        const Report report = StepLoop<State>::examine(system, state, h);
        if (!report || count <= 0) return report;
        if (sweep(state, count)) return {Status::ok, static_cast<int>(count)};
        // Not finite: which step and which particle, one by one.
        return loop_.run(system, state, h, count, [&](State& own) -> Report {
            if (sweep(own, Index(1))) return {};
            sweep_.store(own);
            return {Status::diverged, 0, 0, own.first_not_finite()};
        });
    }

    int threads_;
    step_detail::Sweep<System> sweep_;
    StepLoop<State> loop_;
};

}  // namespace integrator_detail
}  // namespace taut
