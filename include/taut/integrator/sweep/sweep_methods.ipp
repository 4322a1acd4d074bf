// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// The methods that a Sweep knows, by its steps.

namespace taut::integrator_detail::sweep {

template <class System>
template <class AnyState, class Update>
bool Sweep<System>::run(const System& system, AnyState& state, Scalar h, Index count, int threads,
                        const Update& update) {
    load(system, state);
    if (!steps(h, count, threads, update)) return false;
    show(nullptr, nullptr);
    store(state_.planes().x, h, count, state);
    return true;
}

template <class System>
template <class AnyState, class Update>
bool Sweep<System>::run_ahead(const System& system, AnyState& state, Scalar h, Index count,
                              int threads, const Update& update) {
    constexpr bool pushes = ForcePlan<System>::pushes;
    load(system, state, h, pushes);
    bool finite;
    if constexpr (pushes) {
        finite = steps(h, count, threads, WithBoth<Update>{update});
    } else {
        finite = steps(h, count, threads, update);
    }
    if (!finite) return false;
    show(nullptr, nullptr);
    store(state_.planes().x, h, count, state);
    return true;
}

template <class System>
template <class AnyState>
bool Sweep<System>::run_verlet(const System& system, AnyState& state, Scalar h, Index count,
                               int threads, bool go_on) {
    load(system, state);
    const Scalar half = h / 2;
    const auto kick_and_drift = [half](auto& x, auto& v, const auto& a, const auto& step) {
        v += Register(half) * a;
        x += step * v;
    };
    // Two half kicks, as at the end of one call and the start of the next: to the same bits.
    const auto kick_twice_and_drift = [half](auto& x, auto& v, const auto& a, const auto& step) {
        v += Register(half) * a;
        v += Register(half) * a;
        x += step * v;
    };
    if (go_on) {
        show(nullptr, nullptr);
        auto x = state_.whole(state_.planes().x);
        auto v = state_.whole(state_.planes().v);
        v += half * acceleration_;
        x += h * v;
        outside_.pass(h);
        if (!state_.finite()) return false;
    } else if (!steps(h, 1, threads, kick_and_drift)) {
        return false;
    }
    if (!steps(h, count - 1, threads, kick_twice_and_drift)) return false;
    end_x_ = state_.whole(state_.planes().x);
    // The acceleration takes the place of x.
    const auto kick = [half](auto& x, auto& v, const auto& a, const auto&) {
        v += Register(half) * a;
        x = a;
    };
    if (!steps(h, 1, threads, kick)) return false;
    store({end_x_.data(), plan_.stride()}, h, count, state);
    acceleration_ = state_.whole(state_.planes().x);
    return true;
}

template <class System>
template <bool Ahead, class AnyState, class Correct>
bool Sweep<System>::run_corrected(const System& system, AnyState& state, Scalar h, Index count,
                                  int threads, const Correct& correct) {
    // The acceleration takes the place of the new x, which must not be that of the old one.
    load(system, state, Ahead ? h : Scalar(0), Ahead);
    const bool one_by_one = outside_.asks_for_state();
    if (one_by_one && !state_.finite()) return false;
    if (places_.empty()) places_ = plan_.places();
    const auto take = [](auto& x, auto&, const auto& a, const auto&) { x = a; };
    for (Index i = 1; i <= count; ++i) {
        if (Ahead && i > 1) state_.look_ahead(h);
        update_.set_external(outside_.at_state(plan_, state_.planes()));
        if constexpr (Ahead && ForcePlan<System>::pushes) {
            some_steps(h, 1, threads, WithBoth<decltype(take)>{take});
        } else {
            some_steps(h, 1, threads, take);
        }
        const StatePlanes<Scalar> planes = state_.planes();
        correct(PlaceVectors<System>(plan_, places_, planes.x),
                PlaceVectors<System>(plan_, places_, planes.v));
        auto x = state_.whole(planes.x);
        auto v = state_.whole(planes.v);
        v += h * x;
        x = state_.whole(planes.new_x) + h * v;
        const bool check = one_by_one || i == count || i % steps_between_checks == 0;
        if (check && !state_.finite()) return false;
        outside_.pass(h);
    }
    store(state_.planes().x, h, count, state);
    return true;
}

}  // namespace taut::integrator_detail::sweep
