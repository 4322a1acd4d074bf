// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "../support/scene.hpp"

// Scenes whose energy is convex in the positions [T24], and NewtonEuler on them.

namespace taut_test {

/// How a string of stiffness k at the most, and a width w, pulls when it is stretched by u.
enum class Pull {
    linear,    ///< k·u
    bungee,    ///< slope k/4 up to a stretch of w, then k
    yielding,  ///< k·u/(1 + u/w), never more than k·w
};

struct ConvexString {
    Index a, b;
    Pull pull;
    double stiffness, width;  // N/m, m
    double rest_length, damping;
};
/// In long double, by the law itself.
LawAt law_at(const ConvexString& string, long double length);

/// Numbers as the scalar holds them.
struct ConvexScene {
    bool single;
    int dim;
    Eigen::VectorXd mass;
    std::vector<ConvexString> strings;
    Index pinned;  ///< the first ones
    Eigen::VectorXd gravity;
    double mass_proportional, stiffness_proportional;
    Eigen::MatrixXd push;  ///< constant external forces, N
    AnyState state;
};

struct Held {
    Index plane, point;  ///< a particle held in a plane, and one that is led
    Eigen::VectorXd normal, velocity;
};

/// Takes a step of h by NewtonEuler.
taut::Report convex_step(const ConvexScene& scene, double h, AnyState& state,
                         double tolerance = 1e-6, const Held* held = nullptr);

}  // namespace taut_test
