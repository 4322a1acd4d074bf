// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/proof/bracket.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>

#include <cmath>
#include <cstdint>

#include "referee.hpp"

// Limits of small scenes under other flags and modes, judged by the referee.

namespace limits {

using referee::check;
using taut::Index;
using taut::Method;

/// Numbers that are the same everywhere.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : word_(seed * 0x9e3779b97f4a7c15u + 1) {}
    int below(int most) { return static_cast<int>(next() % static_cast<std::uint64_t>(most)); }
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
    }

private:
    std::uint64_t next() {
        word_ ^= word_ << 13;
        word_ ^= word_ >> 7;
        word_ ^= word_ << 17;
        return word_;
    }
    std::uint64_t word_;
};

/// Pairs, rings and stars, whose bounds are tight, and nets at random; each at a pose that
/// stretches it, or at any.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> draw_scene(Dice& dice, bool extreme) {
    const auto size = [&](double low, double high) {
        const double exponent = extreme ? dice.between(-140, 140) : 0;
        return static_cast<Scalar>(dice.between(low, high) * std::pow(10.0, exponent));
    };
    taut::SpringSystem<Scalar, Dim> system;
    const int kind = dice.below(4);
    const int n = kind == 0 ? 2 : 2 * (1 + dice.below(4));
    const bool uniform = dice.below(2) == 0;
    const Scalar mass = size(0.01, 3), k = size(1, 1e5);
    for (int i = 0; i < n; ++i) {
        Eigen::Matrix<Scalar, Dim, 1> x;
        for (int d = 0; d < Dim; ++d) x[d] = static_cast<Scalar>(dice.between(-2, 2));
        system.add_particle(x, uniform ? mass : size(0.01, 3));
    }
    if (n > 2 && dice.below(3) == 0) system.pin(0);
    const int damping = dice.below(4);
    const auto join = [&](int a, int b) {
        const auto x = system.initial_state().x;
        const Scalar l = (x.col(a) - x.col(b)).norm();
        const Scalar L =
            l * static_cast<Scalar>(dice.between(0.2, dice.below(3) == 0 ? 1.5 : 0.999));
        const Scalar c = damping == 1 ? size(0.01, 10) : Scalar(0);
        system.add_spring(
            taut::Spring<Scalar, taut::Hookean>{a, b, {uniform ? k : size(1, 1e5)}, L, c});
    };
    for (int i = 1; i < n; ++i) join(kind == 2 ? 0 : i - 1, i);
    if (kind == 1 && n > 2) join(n - 1, 0);
    for (int more = 0; kind == 3 && more < n; ++more) {
        const int a = dice.below(n);
        join(a, (a + 1 + dice.below(n - 1)) % n);
    }
    if (damping == 2) system.set_rayleigh({dice.between(0, 5), dice.between(0, 1e-3)});
    if (damping == 3) system.set_rayleigh({0, dice.between(0, 1e-2)});
    return system;
}

template <class Scalar, int Dim>
referee::Scene plain(const taut::SpringSystem<Scalar, Dim>& system) {
    referee::Scene scene;
    scene.dim = Dim;
    const auto x = system.initial_state().x;
    for (Index i = 0; i < system.size(); ++i) {
        scene.inverse_mass.push_back(static_cast<double>(system.inverse_mass()[i]));
        for (int d = 0; d < Dim; ++d) scene.x.push_back(static_cast<double>(x(d, i)));
    }
    system.visit_springs([&](const auto& spring) {
        scene.springs.push_back({int(spring.a), int(spring.b), double(spring.stiffness_bound()),
                                 double(spring.rest_length), double(spring.damping)});
    });
    scene.d0 = static_cast<double>(static_cast<Scalar>(system.rayleigh().mass_proportional));
    scene.alpha =
        static_cast<double>(static_cast<Scalar>(system.rayleigh().stiffness_proportional));
    return scene;
}

inline bool is_finite(double x) { return referee::is_finite(&x, 1); }

/// Whether a step of symplectic Euler is stable, or of explicit Euler.
inline bool stable(const referee::Scene& scene, referee::Matrices which, long double h) {
    return referee::smallest(scene, which, 4, -2 * h, -h * h) >= 0;
}
inline bool explicit_stable(const referee::Scene& scene, long double h) {
    return referee::smallest(scene, referee::Matrices::projected, 0, 1, -h) >= -1e-17L * (1 / h) &&
           referee::smallest(scene, referee::Matrices::pose, 4, -2 * h, h * h) >= 0;
}

/// Judges all limits of a scene. @param extreme  numbers from 1e-140 to 1e140
template <class Scalar, int Dim>
void judge_limits(int number, bool extreme) {
    using referee::Matrices;
    Dice dice(static_cast<std::uint64_t>(number) + 1000u * Dim);
    auto system = draw_scene<Scalar, Dim>(dice, extreme);
    const referee::Scene scene = plain(system);
    const auto state = system.initial_state();
    const taut::Stability<Scalar> stability(system, state);
    const auto pose = stability.max_step(Method::symplectic_euler);
    const auto any = taut::any_pose_limit(system);
    const auto energy = taut::energy_limit(system);
    const auto holds = [&](const taut::StepLimit<Scalar>& limit, const char* what,
                           const auto& stable_at) {
        const auto h = static_cast<double>(limit.certified);
        check(limit.unbounded() == !is_finite(h), "unbounded", number);
        if (limit.unbounded()) return void(check(scene.springs.empty(), what, number));
        check(h >= 0 && (h == 0 || stable_at(h)), what, number);
    };
    const auto at = [&](Matrices which) {
        return [&scene, which](long double h) { return stable(scene, which, h); };
    };
    const auto without_gain = [&](long double h) {
        return referee::smallest(scene, Matrices::any_pose, 1, -h / 2, -h * h) >= 0;
    };
    const auto by_explicit = [&](long double h) { return explicit_stable(scene, h); };
    holds(pose, "at the pose", at(Matrices::projected));
    holds(any, "any pose", at(Matrices::any_pose));
    holds(energy, "energy", without_gain);
    holds(stability.max_step(Method::explicit_euler), "explicit Euler", by_explicit);
    check(extreme || pose.certified > 0, "nothing is certified", number);
    check(stability.max_step(Method::implicit_euler).unbounded(), "implicit Euler", number);
    if (extreme) return;

    const auto tight = taut::max_step(stability, Method::symplectic_euler, 1e-6);
    holds(tight, "tight", at(Matrices::pose));
    check(tight.certified >= pose.certified && tight.refuted >= tight.certified, "order", number);
    check(!stable(scene, Matrices::pose, static_cast<double>(tight.refuted)), "refuted", number);
    holds(taut::any_pose_limit(system, 1e-6), "any pose, tight", at(Matrices::any_pose));
    holds(taut::max_step(stability, Method::explicit_euler, 1e-3), "explicit, tight", by_explicit);

    // The window of α, at its ends. It does not count how a stepper in float holds the masses.
    if (sizeof(Scalar) == 4) return;
    referee::Scene damped = scene;
    for (auto& spring : damped.springs) spring.c = 0;
    const double h = 0.7 * static_cast<double>(pose.certified);
    for (const double d0 : {0.0, 0.2 / h}) {
        damped.d0 = d0;
        const auto window = stability.rayleigh_window(Method::symplectic_euler, h, d0);
        if (window.empty != taut::EmptyWindow::none) continue;
        damped.alpha = window.upper;
        check(stable(damped, Matrices::projected, h), "the window's upper end", number);
        const auto forward = stability.rayleigh_window(Method::explicit_euler, h, d0);
        if (forward.empty != taut::EmptyWindow::none) continue;
        for (const double alpha : {forward.lower, forward.upper}) {
            damped.alpha = alpha;
            check(explicit_stable(damped, h), "the window of explicit Euler", number);
        }
    }
}

/// The limits of `count` scenes.
inline void judge(int count) {
    for (int number = 0; number < count; ++number) {
        const bool extreme = number % 4 == 3;
        judge_limits<double, 1>(number, extreme);
        judge_limits<double, 2>(number, extreme);
        judge_limits<double, 3>(number, extreme);
        judge_limits<float, 3>(number, false);
    }
}

}  // namespace limits
