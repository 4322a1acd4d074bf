// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "steps.hpp"

taut::Report bench::taut_steps(taut::SymplecticEuler<Cloth>& stepper, Cloth::State& state, double h,
                               int count) {
    return stepper.step(state, h, count);
}
