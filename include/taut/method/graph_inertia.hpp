// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "symplectic_euler.hpp"

namespace taut::method {

/// The descriptor of GraphInertia with every spring implicit [T33]: symplectic Euler of the mass
/// a = 1 + (hd/2 + (1 + δ)h²k/4)/θ and the damping d + δhk/(2θ), for d of dampers and Rayleigh's α.
/// A stepper whose springs are implicit in part errs less.
struct GraphInertia : SymplecticEuler {
    static constexpr Method method = Method::graph_inertia;
    static constexpr const char* name = "graph_inertia";
    static constexpr int order = 1;
    using Limit = LimitedByDrag;
    static constexpr AnyPose any_pose = AnyPose::every_step;
    /// θ, what GraphInertiaOptions has unless told otherwise.
    static constexpr double margin = 0.83;
    /// δ, likewise.
    static constexpr double dissipation = 0.01;

    /// Symplectic Euler's, of the heavier mode.
    static StepQuadratic step_quadratic(double k, double d, double h) {
        const double a = mass(k, d, h);
        return SymplecticEuler::step_quadratic(k / a, (d + braking(k, h)) / a, h);
    }
    /// The largest |μ| of that polynomial.
    static double spectral_radius(double k, double d, double h) {
        return taut::method_detail::largest_root(step_quadratic(k, d, h));
    }
    /// Infinity: 4a − 2h(d + δhk/(2θ)) − h²k > 0 for every h.
    static double critical_step(double, double) { return std::numeric_limits<double>::infinity(); }
    /// a of a mode.
    static double mass(double k, double d, double h) {
        return 1 + (h * d / 2 + (1 + dissipation) * h * h * std::max(k, 0.0) / 4) / margin;
    }
    /// What its damping grows by, 1/s.
    static double braking(double k, double h) {
        return dissipation * h * std::max(k, 0.0) / 2 / margin;
    }
};

}  // namespace taut::method
