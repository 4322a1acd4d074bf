// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Shows the prediction come true: the linearised scene stays bounded just below the certified step
// and grows as predicted just above the refuted one; the moving cloth keeps its energy.

#include <cmath>
#include <complex>
#include <cstdio>

#include "common/main.hpp"
#include "common/scene.hpp"

namespace {

using taut::Method;
using Linear = taut::LinearSystem<double>;

/// One line of the comparison.
struct Trial {
    double predicted = 0;  // |μ| of the limiting mode
    double measured = 0;   // growth a step, the geometric mean
    taut::Index steps = 0;
    double largest = 0;  // amplitude met, relative to the first
    bool finite = true;
};

/// √(uᵀMu·k + u̇ᵀMu̇): the amplitude of a vibration, blind to its phase.
double amplitude(const Linear& system, const Linear::State& state, double k) {
    const auto m = system.mass().transpose().array();
    return std::sqrt((k * m * state.x.array().square() + m * state.v.array().square()).sum());
}

/// Starts along the eigenvector of the limiting mode's larger multiplier and steps on.
template <class Stepper>
Trial try_step(const Linear& system, const taut::LimitingMode& mode, double h) {
    const auto mu = taut::multipliers(Stepper::method, mode.k, mode.d, h);
    const auto larger = std::abs(mu[0]) >= std::abs(mu[1]) ? mu[0] : mu[1];
    Trial trial;
    trial.predicted = std::abs(larger);
    const double growth = std::log(trial.predicted);
    trial.steps = growth > 1e-4 ? std::lround(std::log(1e3) / growth) : 4000;

    // x⁺ = μx fixes the velocity that belongs to x: by the new one (symplectic) or the old
    // (explicit).
    const bool explicit_euler = Stepper::method == Method::explicit_euler;
    const std::complex<double> speed =
        (larger - 1.0) / (explicit_euler ? std::complex<double>(h) : h * larger);
    auto state = system.initial_state();
    state.x = 1e-3 * mode.shape.transpose();
    state.v = speed.real() * state.x;
    Stepper stepper(system);
    const double start = amplitude(system, state, mode.k);
    trial.largest = 1;
    double now = start;
    for (taut::Index i = 0; i < trial.steps && trial.finite; ++i) {
        trial.finite = static_cast<bool>(stepper.step(state, h));
        now = amplitude(system, state, mode.k);
        trial.largest = std::max(trial.largest, now / start);
    }
    trial.measured = std::exp(std::log(now / start) / static_cast<double>(trial.steps));
    return trial;
}

/// Prints a trial and says whether it went as predicted.
bool print_trial(const char* label, double h, const Trial& trial, bool stable) {
    // Twenty is room for the transients of a non-normal step; 2 % for modes close to the limiting
    // one.
    const bool as_predicted = stable ? trial.finite && trial.largest < 20
                                     : std::abs(trial.measured / trial.predicted - 1) < 0.02;
    std::printf("  %-34s %.4e s %8lld  %10.6f %10.6f  %8.2g  %s\n", label, h,
                static_cast<long long>(trial.steps), trial.predicted, trial.measured, trial.largest,
                as_predicted ? (stable ? "bounded" : "grows as predicted") : "NOT AS PREDICTED");
    return as_predicted;
}

template <class Stepper>
bool try_limit(const char* label, const Linear& linear, const taut::StepLimit<double>& limit,
               const taut::LimitingMode& mode) {
    const std::string name = label;
    bool good = print_trial((name + ", 0.99 certified").c_str(), 0.99 * limit.certified,
                            try_step<Stepper>(linear, mode, 0.99 * limit.certified), true);
    good = print_trial((name + ", 1.01 refuted").c_str(), 1.01 * limit.refuted,
                       try_step<Stepper>(linear, mode, 1.01 * limit.refuted), false) &&
           good;
    return good;
}

/// The scene about its rest pose, without the load that would move it.
Linear unforced(const example::System& system) {
    const auto linear = system.linearize(system.initial_state());
    return {linear.mass(), linear.damping(), linear.stiffness()};
}

bool try_linearised(example::System& system) {
    std::printf(
        "The linearised scene, unforced, started in its limiting mode\n"
        "  %-34s %-12s %8s  %10s %10s  %8s\n",
        "", "step", "steps", "predicted", "measured", "largest");
    const auto pose = system.initial_state();
    bool good = true;
    {
        const taut::Stability<double> stability(system, pose);
        good = try_limit<taut::SymplecticEuler<Linear>>(
            "symplectic Euler", unforced(system), stability.max_step(Method::symplectic_euler),
            stability.limiting_mode());
    }
    {
        const taut::Stability<double> undamped(system, pose);
        const double h = 0.5 * undamped.max_step(Method::symplectic_euler).certified;
        const auto window = undamped.rayleigh_window(Method::explicit_euler, h);
        // Below the middle of the window the stiffest vibration is what sets the limit.
        system.set_rayleigh({0, window.lower + 0.1 * (window.upper - window.lower)});
        std::printf("  with alpha = %.3e s, inside the window (%.3e, %.3e) s of h = %.3e s:\n",
                    system.rayleigh().stiffness_proportional, window.lower, window.upper, h);
        const taut::Stability<double> damped(system, pose);
        good = try_limit<taut::ExplicitEuler<Linear>>("explicit Euler", unforced(system),
                                                      damped.max_step(Method::explicit_euler),
                                                      damped.limiting_mode()) &&
               good;
        system.set_rayleigh({});
    }
    return good;
}

bool try_moving(const example::System& system, double duration) {
    auto state = system.initial_state();
    const auto limit = taut::any_pose_limit(system);
    const double h = 0.95 * limit.certified;
    const double start = system.energy(state);
    taut::SymplecticEuler stepper(system);
    double lowest = start, highest = start, kinetic = 0;
    bool good = true;
    while (good && state.time < duration) {
        good = static_cast<bool>(stepper.step(state, h, 50));
        const double energy = system.energy(state);
        kinetic = std::max(kinetic, system.kinetic_energy(state));
        lowest = std::min(lowest, energy);
        highest = std::max(highest, energy);
    }
    // The energy of a stable symplectic step swings about a constant; an unstable one grows without
    // bound.
    good = good && highest - lowest <= 0.1 * kinetic;
    std::printf(
        "The moving cloth, symplectic Euler at 0.95 of the any-pose limit, %.4e s, for %.3g s\n"
        "  energy within [%+.2e, %+.2e] J of its start, largest kinetic energy %.2e J: %s\n",
        h, state.time, lowest - start, highest - start, kinetic,
        good ? "bounded" : "NOT AS PREDICTED");
    return good;
}

int run(int argc, char** argv) {
    example::SceneOptions options;
    double duration = 2;
    CLI::App app{
        "Compares predicted and simulated stability of a scene. Exit code 2: they differ."};
    options.add_to(app);
    app.add_option("--duration", duration, "simulated time of the moving cloth, s")
        ->check(example::positive())
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv)
    if (!options.given()) throw std::runtime_error("name a mesh or --scene (see --help)");
    if (options.d0 > 0 || options.alpha > 0) {
        throw std::runtime_error("--d0, --alpha: this program chooses the damping itself");
    }
    auto scene = example::make_scene(options);
    std::printf("%s\n", example::describe(scene).c_str());
    const bool linear = try_linearised(scene.system);
    const bool moving = try_moving(scene.system, duration);
    return linear && moving ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
    return example::guarded_main("prediction", [&] { return run(argc, argv); });
}
