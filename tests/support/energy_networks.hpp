// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "random_system.hpp"
#include "referee.hpp"

// Violent scenes and an exact account of their energy, for what [T42] promises.

namespace taut_test {

/// Networks with masses and stiffnesses over `decades`, pins, springs of no rest length and
/// particles on one another.
/// @param dampers  whether every other spring has a damper, up to that of a stiff oscillator
template <class System>
System random_network(Random& random, double decades, bool dampers = false) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    const double side = std::pow(10, decades / 2);
    const auto any = [&] { return static_cast<Scalar>(log_uniform(random, 1 / side, side)); };
    System system;
    const Index particles = 2 + random.below(7);
    for (Index i = 0; i < particles; ++i) {
        const auto place = random.vector<Scalar, Dim>(-1, 1);
        system.add_particle(place, any());
    }
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        const Index springs = 1 + random.below(2 * particles);
        for (Index s = 0; s < springs; ++s) {
            const Index a = random.below(particles);
            const Index b = (a + 1 + random.below(particles - 1)) % particles;
            const auto rest =
                random.below(6) == 0 ? Scalar(0) : static_cast<Scalar>(random.uniform(0.1, 1.5));
            auto parameters = draw_parameters<Scalar>(random, Law{});
            parameters.stiffness = any();
            const double most = std::sqrt(static_cast<double>(parameters.stiffness));
            const bool damped = dampers && s % 2 == 0;
            const auto damping = damped ? log_uniform(random, 1e-2, 1) * most : 0;
            system.add_spring(
                taut::Spring<Scalar, Law>{a, b, parameters, rest, static_cast<Scalar>(damping)});
        }
    });
    for (Index pins = random.below(3); pins > 0; --pins) system.pin(random.below(particles));
    if (random.below(2) == 0) system.set_gravity(random.vector<Scalar, Dim>(-10, 10));
    return system;
}

/// A crumpled pose thrown violently; some particles on one another, and pins at rest.
template <class System>
typename System::State thrown(Random& random, const System& system) {
    auto state = random_state(random, system);
    const double speed = log_uniform(random, 0.01, 100);
    for (Index i = 0; i < system.size(); ++i) {
        if (i > 0 && random.below(8) == 0) state.x.col(i) = state.x.col(i - 1);
        state.v.col(i) *= system.is_pinned(i) ? 0 : static_cast<typename System::Scalar>(speed);
    }
    return state;
}

/// What rounding may add to the energy in a step from `state`, J: of positions, by the forces
/// there, and of velocities.
template <class System>
double rounding(const System& system, const typename System::State& state, double h) {
    using Scalar = typename System::Scalar;
    constexpr double eps = std::numeric_limits<Scalar>::epsilon();
    double sum = 0;
    const double reach = static_cast<double>(state.x.cwiseAbs().maxCoeff());
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const auto dx = (state.x.col(set.b[s]) - state.x.col(set.a[s])).template cast<double>();
            const auto dv = (state.v.col(set.b[s]) - state.v.col(set.a[s])).template cast<double>();
            const auto p = set.parameters[s].template cast<double>();
            const auto L = static_cast<double>(set.rest_length[s]);
            const double l = std::max(dx.norm(), 1e-30);
            const double k = Law::stiffness_bound(p, L);
            const double size = reach + l + L + h * dv.norm();
            const double pull = std::abs(Law::tension(p, L, l)) + h * k * dv.norm();
            // A force is off by eps of what it is made of, and moves its ends at their speed.
            sum += eps * (pull + k * size) * (size + h * dv.norm());
        }
    });
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        const auto v = state.v.col(i).template cast<double>().norm();
        const auto g = system.gravity().template cast<double>().norm();
        const auto m = static_cast<double>(system.mass(i));
        sum += eps * m * ((v + h * g) * (v + h * g) + g * reach);
    }
    return 32 * sum;
}

/// H, J, in long double.
template <class System>
Real total_energy(const System& system, const typename System::State& state) {
    const auto point = [](const auto& column) { return column.template cast<Real>().eval(); };
    Real sum = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        const auto m = static_cast<Real>(system.mass(i));
        sum += m * point(state.v.col(i)).squaredNorm() / 2 -
               m * point(system.gravity()).dot(point(state.x.col(i)));
    }
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const Real l = (point(state.x.col(set.b[s])) - point(state.x.col(set.a[s]))).norm();
            sum += Law::energy(set.parameters[s].template cast<Real>(),
                               static_cast<Real>(set.rest_length[s]), l);
        }
    });
    return sum;
}

/// How many of `steps` raise the energy by more than rounding; all if one fails.
template <class Stepper, class System>
int rises(const System& system, typename System::State state, double h, int steps) {
    using Scalar = typename System::Scalar;
    Stepper stepper(system);
    int count = 0;
    auto energy = total_energy(system, state);
    for (int i = 0; i < steps; ++i) {
        const double allowed = rounding(system, state, h);
        if (!stepper.step(state, static_cast<Scalar>(h))) return steps;
        const auto next = total_energy(system, state);
        count += next > energy + allowed;
        energy = next;
    }
    return count;
}

}  // namespace taut_test
