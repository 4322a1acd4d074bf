// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/guard/guard.hpp>

#include "../support/scene_on.hpp"
#include "guard_scenes.hpp"

namespace taut_test {

template <class Scalar>
taut::GuardedReport<double> to_any(const taut::GuardedReport<Scalar>& r) {
    return {r.status,
            r.taken,
            r.parts,
            r.trimmed,
            r.again,
            r.frozen,
            r.substeps,
            static_cast<double>(r.h),
            static_cast<double>(r.advanced),
            r.energy,
            r.work,
            r.balance,
            r.slack,
            r.blind,
            r.where,
            r.spring,
            r.force};
}

/// Calls what takes an AnyState.
template <class State, class Call, class... Numbers>
auto call_any(const Call& what, State& own, Numbers... numbers) {
    AnyState touched = to_any(own);
    struct Back {  // if it throws, too
        const AnyState& touched;
        State& own;
        ~Back() { own = from_any<State>(touched); }
    } back{touched, own};
    return what(touched, numbers...);
}

template <class Stepper, class System, bool responds = true>
class GuardOn : public AnyGuard {
public:
    template <class... More>
    explicit GuardOn(const System& system, More&&... more) : guard_(system, more...) {}

    taut::GuardedReport<double> advance(AnyState& any, double span,
                                        const Respond& respond) override {
        const auto h = static_cast<typename System::Scalar>(span);
        auto state = from_any<State>(any);
        struct Back {
            const State& state;
            AnyState& any;
            ~Back() { any = taut_test::to_any(state); }
        } back{state, any};
        if (!respond) return taut_test::to_any(guard_.advance(state, h));
        if constexpr (responds) {
            return taut_test::to_any(
                guard_.advance(state, h, [&](State& own) { call_any(respond, own); }));
        }
        throw std::logic_error("this guard takes no response");
    }

private:
    using State = typename System::State;
    taut::Guarded<Stepper, System> guard_;
};

}  // namespace taut_test
