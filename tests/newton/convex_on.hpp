// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/newton/newton.hpp>

#include "../support/held_once.hpp"
#include "../support/scene_on.hpp"
#include "convex_scene.hpp"

namespace taut_test {

struct WideString {
    static constexpr bool convex = true;

    template <class Scalar>
    struct Parameters {
        Scalar stiffness;  // N/m
        Scalar width;      // m
        Pull pull;

        void require_valid(const char* where) const {
            taut::require_non_negative(where, "stiffness", stiffness);
        }
        template <class Other>
        Parameters<Other> cast() const {
            return {static_cast<Other>(stiffness), static_cast<Other>(width), pull};
        }
    };
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar u = std::max(l - L, Scalar(0));
        if (p.pull == Pull::linear) return p.stiffness * u;
        if (p.pull == Pull::yielding) return p.stiffness * u / (1 + u / p.width);
        return p.stiffness * (u / 4 + Scalar(0.75) * std::max(u - p.width, Scalar(0)));
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        if (!(l > L)) return 0;
        if (p.pull == Pull::linear) return p.stiffness;
        const Scalar root = 1 + (l - L) / p.width;
        if (p.pull == Pull::yielding) return p.stiffness / (root * root);
        return l - L > p.width ? p.stiffness : p.stiffness / 4;
    }
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar u = std::max(l - L, Scalar(0));
        const Scalar beyond = std::max(u - p.width, Scalar(0));
        if (p.pull == Pull::linear) return p.stiffness / 2 * u * u;
        if (p.pull == Pull::bungee) return p.stiffness / 8 * (u * u + 3 * beyond * beyond);
        // u/w − ln(1 + u/w) cancels where u is small: ½r² − ⅓r³ + ¼r⁴ …
        const Scalar r = u / p.width;
        const Scalar area =
            r < Scalar(1e-3) ? r * r * (Scalar(0.5) - r / 3 + r * r / 4) : r - std::log1p(r);
        return p.stiffness * p.width * p.width * area;
    }
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar) {
        return p.stiffness;
    }
};

template <class Scalar, int Dim>
using Convex = taut::SpringSystem<Scalar, Dim, WideString>;

template <class System>
System system_of(const ConvexScene& scene) {
    using Scalar = typename System::Scalar;
    const auto scalar = [](double number) { return static_cast<Scalar>(number); };
    System system;
    for (Index i = 0; i < scene.mass.size(); ++i)
        system.add_particle(scene.state.x.col(i).cast<Scalar>(), scalar(scene.mass[i]));
    for (const ConvexString& s : scene.strings) {
        const auto k = scalar(s.stiffness), L = scalar(s.rest_length), c = scalar(s.damping);
        system.add_spring(
            taut::Spring<Scalar, WideString>{s.a, s.b, {k, scalar(s.width), s.pull}, L, c});
    }
    for (Index i = 0; i < scene.pinned; ++i) system.pin(i);
    system.set_gravity(scene.gravity.cast<Scalar>());
    system.set_rayleigh({scene.mass_proportional, scene.stiffness_proportional});
    for (Index i = 0; i < scene.push.cols(); ++i)
        system.set_constant_force(i, scene.push.col(i).cast<Scalar>());
    return system;
}

template <class System>
taut::Report step_convex(const ConvexScene& scene, double h, AnyState& any, double tolerance,
                         const Held* held) {
    using Scalar = typename System::Scalar;
    const auto system = system_of<System>(scene);
    typename taut::NewtonEuler<System>::Options options;
    options.iterations = 300;
    options.tolerance = tolerance;
    taut::NewtonEuler<System> stepper(system, options);
    if (held) {
        stepper.constraints().hold_in_plane(held->plane, held->normal.cast<Scalar>(), 10);
        stepper.constraints().prescribe(held->point, held->velocity.cast<Scalar>());
    }
    auto state = from_any<typename System::State>(any);
    const auto report = stepper.step(state, static_cast<Scalar>(h));
    any = to_any(state);
    return report;
}

/// Of one scalar or the other.
template <int Dim>
taut::Report step_in(const ConvexScene& scene, double h, AnyState& any, double tolerance,
                     const Held* held) {
    return scene.single ? step_convex<Convex<float, Dim>>(scene, h, any, tolerance, held)
                        : step_convex<Convex<double, Dim>>(scene, h, any, tolerance, held);
}

/// Compiled apart.
taut::Report step_in_2d(const ConvexScene& scene, double h, AnyState& any, double tolerance,
                        const Held* held);
taut::Report step_in_3d(const ConvexScene& scene, double h, AnyState& any, double tolerance,
                        const Held* held);

}  // namespace taut_test
