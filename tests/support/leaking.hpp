// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/integrator/symplectic_euler.hpp>

namespace taut_test {

/// What a Leaking stepper gains, and what was spent on it.
struct Leak {
    double rate = 0;        ///< of the velocity, 1/s
    double above = 0;       ///< s; shorter steps gain nothing
    taut::Index steps = 0;  ///< taken so far
};

/// Symplectic Euler that lets the velocity grow. Keeps a reference to the leak.
template <class System>
class Leaking {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr taut::Method method = taut::Method::symplectic_euler;

    Leaking(const System& system, Leak& leak) : stepper_(system), leak_(&leak) {}
    taut::Report step(State& state, Scalar h, taut::Index count = 1) {
        taut::Report report;
        for (taut::Index i = 0; i < count && report; ++i) {
            report = stepper_.step(state, h);
            if (static_cast<double>(h) <= leak_->above) continue;
            state.v *= 1 + static_cast<Scalar>(leak_->rate) * h;
        }
        leak_->steps += count;
        return report;
    }

private:
    taut::SymplecticEuler<System> stepper_;
    Leak* leak_;
};

}  // namespace taut_test
