// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/concepts.hpp"

namespace taut {

/// The extrapolation method of W. B. Gragg on ẋ = v, v̇ = M⁻¹f(x, v), of order 12 where the force is
/// smooth: the modified midpoint rule with 2, 4 … 12 substeps of H, extrapolated to none (E.
/// Hairer, S. P. Nørsett, G. Wanner, "Solving ODEs I", II.9). Explicit, 37 force evaluations a
/// step; for references, not for frames. Pinned particles keep the velocity that they have.
template <class System>
class GraggExtrapolation {
    static_assert((require_system<System>(), true));

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int columns = 6;
    static constexpr int order = 2 * columns;

    /// Keeps a reference: the system must outlive the stepper.
    explicit GraggExtrapolation(const System& system) : system_(&system) {}
    explicit GraggExtrapolation(const System&&) = delete;

    /// Takes `count` steps of H, s. @returns whether the state stayed finite
    bool step(State& state, Scalar H, Index count) {
        const Scalar start = state.time;
        for (Index i = 0; i < count; ++i) {
            advance(state, H);
            state.time = start + static_cast<Scalar>(i + 1) * H;
        }
        return state.finite();
    }

private:
    void advance(State& state, Scalar H) {
        rate(state, rate_);
        const State first_rate = rate_;
        for (int j = 0; j < columns; ++j) {
            const int n = 2 * (j + 1);
            const Scalar h = H / static_cast<Scalar>(n);
            State before = state;
            State now = plus(state, h, first_rate);
            for (int i = 1; i < n; ++i) {
                rate(now, rate_);
                State next = plus(before, 2 * h, rate_);
                before = std::move(now);
                now = std::move(next);
            }
            // Aitken and Neville on powers of (H/n)²: table_[k] holds the k-th column.
            for (int k = 0; k < j; ++k) {
                const auto ratio = static_cast<Scalar>(n) / static_cast<Scalar>(2 * (j - k));
                const Scalar weight = 1 / (ratio * ratio - 1);
                const auto extend = [&](auto& value, const auto& earlier) {
                    return (value + weight * (value - earlier)).eval();
                };
                State better = now;
                better.x = extend(now.x, table_[k].x);
                better.v = extend(now.v, table_[k].v);
                table_[k] = std::move(now);
                now = std::move(better);
            }
            table_[j] = std::move(now);
        }
        state.x = table_[columns - 1].x;
        state.v = table_[columns - 1].v;
    }
    /// (ẋ, v̇) in the places of (x, v).
    void rate(const State& state, State& into) {
        system_->force(state, f_);
        into.x = state.v;
        into.v = f_.array().rowwise() * system_->inverse_mass().transpose().array();
    }
    static State plus(const State& a, Scalar h, const State& rate) {
        State sum = a;
        sum.x += h * rate.x;
        sum.v += h * rate.v;
        sum.time = a.time + h;
        return sum;
    }

    const System* system_;
    State rate_;
    State table_[columns];
    decltype(State::x) f_;  // Dim × n, N
};

}  // namespace taut
