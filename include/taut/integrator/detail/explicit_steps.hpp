// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "../../model/spring_system.hpp"
#include "../explicit_options.hpp"
#include "../sweep/sweep.hpp"
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

/// Steps of an explicit method: of a SpringSystem by a sweep, of other systems by System::force.
template <class System>
class ExplicitSteps {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    explicit ExplicitSteps(const ExplicitOptions& options);
    ExplicitSteps(const ExplicitSteps&) = default;
    ExplicitSteps(ExplicitSteps&&) = default;
    ExplicitSteps& operator=(const ExplicitSteps&) = default;
    ExplicitSteps& operator=(ExplicitSteps&&) = default;
    ~ExplicitSteps();

    /// Steps of a SpringSystem by its sweep are shown to that; null ends it.
    void watch(sweep::StepWatch<Scalar, System::Dim>* by) { sweep_.watch(by); }
    /// Steps of a method that needs one acceleration.
    /// @param update  update(x, v, a, h): x and v, of one step, by the acceleration a = M⁻¹f(x, v);
    ///                arrays or registers
    template <class AnyState, class Update>
    Report run(const System& system, AnyState& state, Scalar h, Index count, const Update& update) {
        return run(
            system, state, h, count,
            [&](auto& sweep, int threads) {
                return sweep.run(system, state, h, count, threads, update);
            },
            [&](State& own) {
                update_force(system, own);
                update(own.x.array(), own.v.array(), acceleration(system), h);
            });
    }
    /// @param by_sweep  bool by_sweep(sweep, threads): all steps at once; where not all is
    ///                  finite, `state` is not touched
    /// @param plain     plain(State&): one step in place
    template <class AnyState, class BySweep, class Plain>
    Report run(const System& system, AnyState& state, Scalar h, Index count, BySweep&& by_sweep,
               Plain&& plain) {
        if constexpr (model_detail::is_spring_system_v<System>) {
            const Report report = StepLoop<State>::check(system, state, h);
            if (!report || count <= 0) return report;
            if (by_sweep(sweep_, options_.threads)) {
                return {Status::ok, static_cast<int>(count)};
            }
            // Not finite: the steps below find out which step and which particle.
        }
        return loop_.run(system, state, h, count, [&](State& own) -> Report {
            plain(own);
            return {};
        });
    }
    /// The force at a state, by the plain path.
    void update_force(const System& system, const State& state) { system.force(state, f_); }
    /// Steps with the springs one step ahead [T42]. @param update  as of run()
    template <class AnyState, class Update>
    Report run_ahead(const System& system, AnyState& state, Scalar h, Index count,
                     const Update& update) {
        return run(
            system, state, h, count,
            [&](auto& sweep, int threads) {
                return sweep.run_ahead(system, state, h, count, threads, update);
            },
            [&](State& own) {
                system.force_ahead(own, h, f_);
                update(own.x.array(), own.v.array(), acceleration(system), h);
            });
    }
    /// One step by accelerations that are corrected all together, by the plain path.
    /// @tparam Ahead   and correct: as of Sweep::run_corrected
    template <bool Ahead = false, class Correct>
    void corrected_step(const System& system, State& state, Scalar h, const Correct& correct) {
        if constexpr (Ahead) {
            system.force_ahead(state, h, f_);
        } else {
            update_force(system, state);
        }
        f_ = acceleration(system).matrix().eval();
        correct(ColumnVectors{f_}, ColumnVectors{state.v});
        state.v += h * f_;
        state.x += h * state.v;
    }
    /// M⁻¹f of that force, Dim × n, m/s².
    auto acceleration(const System& system) const {
        return f_.array().rowwise() * system.inverse_mass().transpose().array();
    }

private:
    struct None {};
    /// As sweep::PlaceVectors.
    struct ColumnVectors {
        decltype(State::x)& columns;

        auto operator()(Index i) const { return columns.col(i); }
        template <class Vector>
        void set(Index i, const Vector& vector) const {
            columns.col(i) = vector;
        }
    };

    ExplicitOptions options_;
    std::conditional_t<model_detail::is_spring_system_v<System>, sweep::Sweep<System>, None> sweep_;
    StepLoop<State> loop_;
    decltype(State::x) f_;  // force, Dim × n, N
};

template <class System>
ExplicitSteps<System>::ExplicitSteps(const ExplicitOptions& options) : options_(options) {
    if (options.threads < 1)
        fail("ExplicitOptions: threads is ", options.threads, "; it must be >= 1");
}

template <class System>
ExplicitSteps<System>::~ExplicitSteps() = default;  // compiled once

}  // namespace integrator_detail
}  // namespace taut
