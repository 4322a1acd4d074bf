// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A rope of one's own, what limits its step, damping, and large steps. docs/tutorial.md reads
// along.

#include <cmath>
#include <cstdio>
#include <taut/taut.hpp>

namespace {

using Rope = taut::SpringSystem<double, 3>;
using taut::Method;

/// Swings for two seconds in steps of at most h, s.
/// @returns the share of the energy above rest that is lost; NaN if the state overflowed
template <class Stepper, class... Options>
double loss(const Rope& rope, Rope::State state, double h, const Options&... options) {
    Stepper stepper(rope, options...);
    const auto steps = static_cast<int>(std::ceil(2 / h));
    const double before = rope.energy(state);
    if (!stepper.step(state, 2.0 / steps, steps)) return NAN;
    Rope::State lowest = state;
    if (!taut::static_equilibrium(rope, lowest)) return NAN;
    return (before - rope.energy(state)) / (before - rope.energy(lowest));
}

void print(const char* what, double lost) {
    if (std::isfinite(lost)) {
        std::printf("%s: %.1f %% of the energy lost in 2 s\n", what, 100 * lost);
    } else {
        std::printf("%s: overflow\n", what);
    }
}

}  // namespace

int main() {
    Rope rope;
    for (int i = 0; i <= 20; ++i) rope.add_particle({0.05 * i, 0, 0}, 0.01);  // m, kg
    for (int i = 0; i < 20; ++i) rope.add_spring(i, i + 1, 5000);             // N/m
    const auto lamp = rope.add_particle({1, 0, -0.1}, 2);
    const auto hook = rope.add_spring(20, lamp, 50000);
    rope.pin(0);
    rope.set_gravity({0, 0, -9.81});
    const auto state = rope.initial_state();

    taut::Stability<double> stability(rope, state);
    const auto limit = stability.max_step(Method::symplectic_euler);
    std::printf("%.3e s is proved, %.3e s fails\n", limit.certified, limit.refuted);
    const auto spring = stability.limiting_springs(1).front();
    std::printf("held down by spring %d between particles %d and %d: %.0f %%\n", int(spring.index),
                int(spring.a), int(spring.b), 100 * spring.share);

    rope.set_stiffness(hook, 5000);
    stability.update(rope, state);
    std::printf("with a softer hook: %.3e s\n",
                stability.max_step(Method::symplectic_euler).certified);

    const double moving = taut::any_pose_limit(rope).certified;
    std::printf("at any pose: %.3e s\n", moving);
    const taut::ExplicitOptions damped{1, taut::recipe.damping};
    const double step = taut::recipe.safety * moving;
    print("symplectic Euler by the recipe",
          loss<taut::SymplecticEuler<Rope>>(rope, state, step, damped));
    const auto energy = taut::energy_limit(rope);
    std::printf("for the energy: %.3e s\n", energy.certified);
    rope.set_graph_damping(energy.alpha(0.9 * energy.certified).lower);
    print("symplectic Euler below it",
          loss<taut::SymplecticEuler<Rope>>(rope, state, 0.9 * energy.certified));
    rope.set_graph_damping(0);

    const double h = 2e-4;
    print("explicit Euler at 2e-4 s", loss<taut::ExplicitEuler<Rope>>(rope, state, h));
    const auto alpha = stability.rayleigh_window(Method::explicit_euler, h);
    std::printf("it needs alpha in (%.2e, %.2e) s\n", alpha.lower, alpha.upper);
    rope.set_rayleigh({0, 1.5 * alpha.lower});
    print("explicit Euler with alpha", loss<taut::ExplicitEuler<Rope>>(rope, state, h));
    rope.set_rayleigh({0, 2 * alpha.upper});
    print("explicit Euler with too much", loss<taut::ExplicitEuler<Rope>>(rope, state, h));

    rope.set_rayleigh({0, 0});
    print("implicit Euler at 1/60 s", loss<taut::ImplicitEuler<Rope>>(rope, state, 1.0 / 60));
    print("implicit Euler at 1/600 s", loss<taut::ImplicitEuler<Rope>>(rope, state, 1.0 / 600));
    print("BDF2 at 1/60 s", loss<taut::Bdf2<Rope>>(rope, state, 1.0 / 60));
}
