// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/network/spring_system.hpp>
#include <taut/network/state_view.hpp>
#include <taut/proof/pencil.hpp>

namespace taut_test {

/// Leapfrog whose drag c, 1/s, is taken half at either end of the step:
///     v⁺ = ((1 − hc/2) v + h f/m)/(1 + hc/2),  x⁺ = x + h v⁺.
/// On a mode of stiffness k and damping d of the system its multipliers solve
///     (1 + hc/2) μ² − (2 − hd − h²k) μ + 1 − hc/2 − hd = 0,
/// which leave the unit circle at 2hd + h²k = 4, whatever c is.
template <class System>
class DragLeapfrog {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int order = 1;

    /// Keeps a reference: the system must outlive the stepper.
    DragLeapfrog(const System& system, double drag) : system_(&system), drag_(drag) {}
    DragLeapfrog(const System&&, double) = delete;

    /// On failure the state is as it was before.
    taut::Report step(State& state, Scalar h, Index count = 1) {
        if (!(h > 0) || !std::isfinite(h)) return {taut::Status::invalid_step};
        const Index n = system_->size();
        if (state.x.cols() != n || state.v.cols() != n) return {taut::Status::invalid_state};
        if (!state.finite()) return {taut::Status::invalid_state, 0, 0, state.first_not_finite()};
        start_ = state;
        for (Index i = 0; i < count; ++i) {
            advance(state, h);
            if (state.finite()) continue;
            const Index where = state.first_not_finite();
            state = start_;
            return {taut::Status::diverged, static_cast<int>(i), 0, where};
        }
        return {taut::Status::ok, static_cast<int>(count)};
    }
    /// An engine's own arrays.
    template <class Stored>
    taut::Report step(taut::StateView<Stored, System::Dim>& view, Scalar h, Index count = 1) {
        view.copy_to(viewed_);
        const taut::Report report = step(viewed_, h, count);
        if (report) view.copy_from(viewed_);
        return report;
    }

    /// Its condition, for Stability::max_step: 2hD + h²K⁺ ≺ 4M. The first h fulfils it; from h to
    /// s·h, s ≥ 1, the sum grows by s² at most. It grows with h, so it holds at all smaller ones.
    static double certified(const taut::Pencil& pencil) {
        using namespace taut::matrices;
        const double h = 2 / (pencil.upper_bound(D) + std::sqrt(pencil.upper_bound(K_plus)));
        const double sum = std::isinf(h) ? 0 : pencil.upper_bound(2 * h * D + h * h * K_plus);
        return h * std::sqrt(4 / sum);
    }

private:
    void advance(State& state, Scalar h) {
        system_->force(state, f_);
        const Scalar half = h * static_cast<Scalar>(drag_) / 2;
        for (Index i = 0; i < state.v.cols(); ++i) {
            const Scalar w = system_->inverse_mass()[i];
            if (w > 0)  // a pin keeps its velocity
                state.v.col(i) = ((1 - half) * state.v.col(i) + h * w * f_.col(i)) / (1 + half);
        }
        state.x += h * state.v;
        state.time += h;
    }

    const System* system_;
    double drag_;
    typename System::Force f_;
    State start_, viewed_;
};

}  // namespace taut_test
