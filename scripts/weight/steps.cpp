// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// One that only steps.

#include <taut/taut.hpp>

int main() {
    taut::SpringSystem<float, 3> cloth = taut::hanging_cloth<float>({32, 32});
    auto state = cloth.initial_state();
    taut::SymplecticEuler stepper(cloth);
    return stepper.step(state, 1e-4f, 1000) ? 0 : 1;
}
