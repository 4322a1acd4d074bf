// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The question of M. Shinya's paper: how long may a step be, and which damping makes it so?

#include <cstdio>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/suitesparse/suitesparse.hpp>
#include <taut/taut.hpp>

int main() {
    auto cloth = taut::hanging_cloth<double>({64, 64});
    auto state = cloth.initial_state();

    taut::Stability<double> stability(cloth, state);
    double h = stability.max_step(taut::Method::symplectic_euler).certified;  // s, proved
    auto alpha = stability.rayleigh_window(taut::Method::explicit_euler, h / 2);
    taut::ImplicitEuler<decltype(cloth), taut::Cholmod<double>> implicit(cloth);
    auto report = implicit.step(state, 1.0 / 60);  // stable, linearised, at every step
    std::printf("%.3e s; explicit Euler at half of it: alpha in (%.3e, %.3e) s\n", h, alpha.lower,
                alpha.upper);
    return report ? 0 : 1;
}
