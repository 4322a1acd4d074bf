// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Shows the prediction come true: the linearised scene stays bounded just below the certified step
// and grows as predicted just above the refuted one; the moving cloth gains no energy.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/proof/bracket.hpp>
#include <utility>

#include "common/main.hpp"
#include "common/number.hpp"
#include "common/progress.hpp"
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

/// √(uᵀMu·k + u̇ᵀMu̇): the amplitude of the whole state.
double amplitude(const Linear& system, const Linear::State& state, double k) {
    const auto m = system.mass().transpose().array();
    return std::sqrt((k * m * state.x.array().square() + m * state.v.array().square()).sum());
}

/// The part of the state along the mode's eigenvector of μ: a step multiplies it by |μ|, whatever
/// the phase and the other modes.
double amplitude(const Linear& system, const Linear::State& state, const taut::Mode& mode,
                 Method method, std::complex<double> mu, double h) {
    const Eigen::VectorXd weight = system.mass().cwiseProduct(mode.shape);
    const double q = state.x.row(0).dot(weight);
    const double p = state.v.row(0).dot(weight);
    // With the step matrix A of (q, p), (μ − A₂₂, A₁₂) is its left eigenvector.
    const double a22 = 1 - h * mode.d;
    const double a12 = method == Method::explicit_euler ? h : h * a22;
    return std::abs((mu - a22) * q + a12 * p);
}

/// Starts along the eigenvector of the limiting mode's larger multiplier and steps on.
template <class Stepper>
Trial try_step(const Linear& system, const taut::Mode& mode, double h, bool stable) {
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
    // Bounded must be everything; growth is predicted for the limiting mode alone.
    const auto measure = [&] {
        return stable ? amplitude(system, state, mode.k)
                      : amplitude(system, state, mode, Stepper::method, larger, h);
    };
    Stepper stepper(system);
    const double start = measure();
    trial.largest = 1;
    double now = start;
    for (taut::Index i = 0; i < trial.steps && trial.finite; ++i) {
        trial.finite = static_cast<bool>(stepper.step(state, h));
        now = measure();
        trial.largest = std::max(trial.largest, now / start);
    }
    trial.measured = std::exp(std::log(now / start) / static_cast<double>(trial.steps));
    return trial;
}

/// Prints a trial and says whether it went as predicted.
bool print_trial(const char* label, double h, const Trial& trial, bool stable) {
    // Twenty is room for the transients of a non-normal step; 2 % for the mode's own error.
    const bool as_predicted =
        stable ? trial.finite && trial.largest < 20
               : std::abs(std::log(trial.measured) / std::log(trial.predicted) - 1) < 0.02;
    const std::string step = stable ? example::rounded_down(h, 5) : example::rounded_up(h, 5);
    std::printf("  %-34s %s s %8lld  %10.6f %10.6f  %8.2g  %s\n", label, step.c_str(),
                static_cast<long long>(trial.steps), trial.predicted, trial.measured, trial.largest,
                as_predicted ? (stable ? "bounded" : "grows as predicted") : "NOT AS PREDICTED");
    return as_predicted;
}

/// A limit to try, with the scene about its rest pose, without the load that would move it.
struct Limited {
    Linear linear;
    taut::StepLimit<double> limit;
    taut::Mode mode;
};

/// All that the trials need, found before the first of them.
struct Plan {
    Limited symplectic;
    Limited explicit_euler;
    double alpha = 0;        // s, of the explicit trial
    double window_step = 0;  // s
    taut::AlphaWindow window;
    double moving_step = 0;  // s
};

/// Throws unless there are a certified and a refuted step.
void require_steps(const char* label, const taut::StepLimit<double>& limit) {
    if (limit.certified > 0 && std::isfinite(limit.certified) && std::isfinite(limit.refuted))
        return;
    throw std::runtime_error("nothing to try with " + std::string(label) + ": " +
                             describe(limit.cause));
}

Limited find_limit(const char* label, const example::System& system, Method method) {
    const auto pose = system.initial_state();
    const taut::Stability<double> stability(system, pose);
    const auto limit = taut::bracket(stability, method);
    require_steps(label, limit);
    const auto linear = taut::linearize(system, pose);
    return {{linear.mass(), linear.damping(), linear.stiffness()},
            limit,
            taut::limiting_mode(stability)};
}

Plan make_plan(example::System& system, double duration) {
    Limited symplectic = find_limit("symplectic Euler", system, Method::symplectic_euler);
    const double h = 0.5 * symplectic.limit.certified;
    const auto window = taut::Stability<double>(system, system.initial_state())
                            .rayleigh_window(Method::explicit_euler, h);
    if (window.empty != taut::EmptyWindow::none) {
        throw std::runtime_error("nothing to try with explicit Euler: no alpha is proved stable: " +
                                 std::string(describe(window.empty)));
    }
    const auto moving = taut::energy_bracket(system);
    require_steps("the moving cloth", moving);
    const double moving_step = moving.certified;
    if (duration / moving_step > 1e7) {
        char text[96];
        std::snprintf(text, sizeof text, "--duration: %.3g s are more than 1e7 steps of %.3g s",
                      duration, moving_step);
        throw std::runtime_error(text);
    }
    // Below the middle of the window the stiffest vibration is what sets the limit.
    const double alpha = window.lower + 0.1 * (window.upper - window.lower);
    system.set_rayleigh({0, alpha});
    Limited damped = find_limit("explicit Euler", system, Method::explicit_euler);
    system.set_rayleigh({});
    return {std::move(symplectic), std::move(damped), alpha, h, window, moving_step};
}

template <class Stepper>
bool try_limit(const char* label, const Limited& limited) {
    const std::string name = label;
    const auto& [linear, limit, mode] = limited;
    const double below = 0.99 * limit.certified;
    const double above = 1.01 * limit.refuted;
    const bool bounded = print_trial((name + ", 0.99 certified").c_str(), below,
                                     try_step<Stepper>(linear, mode, below, true), true);
    const bool grows = print_trial((name + ", 1.01 refuted").c_str(), above,
                                   try_step<Stepper>(linear, mode, above, false), false);
    return bounded && grows;
}

bool try_linearised(const Plan& plan) {
    std::printf(
        "The linearised scene, unforced, started in its limiting mode\n"
        "  %-34s %-12s %8s  %10s %10s  %8s\n",
        "", "step", "steps", "predicted", "measured", "largest");
    const bool symplectic =
        try_limit<taut::SymplecticEuler<Linear>>("symplectic Euler", plan.symplectic);
    std::printf("  with alpha = %.3e s, inside the window (%s, %s) s of h = %.3e s:\n", plan.alpha,
                example::rounded_up(plan.window.lower, 4).c_str(),
                example::rounded_down(plan.window.upper, 4).c_str(), plan.window_step);
    const bool damped =
        try_limit<taut::ExplicitEuler<Linear>>("explicit Euler", plan.explicit_euler);
    return symplectic && damped;
}

bool try_moving(const example::System& system, double h, double duration) {
    auto state = system.initial_state();
    const double start = system.energy(state);
    taut::EnergyStableEuler stepper(system);
    double last = start, most = 0, kinetic = 0;
    bool good = true;
    while (good && state.time < duration) {
        good = static_cast<bool>(stepper.step(state, h, 50));
        const double energy = system.energy(state);
        good = good && std::isfinite(energy);
        kinetic = std::max(kinetic, system.kinetic_energy(state));
        most = std::max(most, energy - last);
        last = energy;
    }
    good = good && most <= 1e-9 * kinetic;  // rounding
    std::printf(
        "The moving cloth, EnergyStableEuler, %s s, for %.3g s\n"
        "  energy changes by %+.2e J, largest kinetic energy %.2e J: %s\n",
        example::rounded_down(h, 5).c_str(), state.time, last - start, kinetic,
        good ? "never rises" : "NOT AS PREDICTED");
    return good;
}

int run(int argc, char** argv) {
    example::SceneOptions options;
    double duration = 2;
    CLI::App app{
        "Compares predicted and simulated stability of a scene. Exit code 2: they differ."};
    example::add_version(app, "prediction");
    options.add_to(app);
    app.add_option("--duration", duration, "simulated time of the moving cloth, s")
        ->transform(example::time_quantity())
        ->check(example::positive())
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv)
    if (options.d0 > 0 || options.alpha > 0) {
        throw std::runtime_error("--d0, --alpha: this program chooses the damping itself");
    }
    if (options.gravity == 0)
        throw std::runtime_error("--gravity: without any the moving cloth stands still");
    const bool watched = example::stderr_is_a_terminal();
    example::Progress progress(
        2, watched ? example::say_on_stderr("prediction") : example::Progress::Say());
    progress.at("stepping just below and just above the limits, then the moving cloth");
    auto scene = example::make_scene(options);
    const Plan plan = make_plan(scene.system, duration);
    std::printf("%s\n%s\n", example::describe(scene).c_str(),
                example::describe_space(scene).c_str());
    const bool linear = try_linearised(plan);
    const bool moving = try_moving(scene.system, plan.moving_step, duration);
    return linear && moving ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
    return example::guarded_main("prediction", [&] { return run(argc, argv); });
}
