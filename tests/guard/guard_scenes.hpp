// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <taut/guard/report.hpp>

#include "../support/cloth_scene.hpp"

namespace taut_test {

/// What a user gives: a step of h, s, and whether it could be taken; what comes after a step.
using Trial = std::function<bool(AnyState& state, double h)>;
using Respond = std::function<void(AnyState& state)>;

constexpr double frame = 1.0 / 60;  // s

/// What some frames came to.
struct Frames {
    double work = 0;                         // J
    int trimmed = 0, again = 0, frozen = 0;  // how many
    bool all_ok = true;
};

class AnyGuard {
public:
    virtual ~AnyGuard() = default;
    virtual taut::GuardedReport<double> advance(AnyState& state, double span,
                                                const Respond& respond = {}) = 0;
    /// @param each  called after each
    Frames advance_all(AnyState& state, int frames, const Respond& each = {});
};

/// The scene must outlive the guard. By velocity Verlet: Laws::hookean of double 1d and float 2d,
/// Laws::any of double 3d, Laws::strings of float 3d.
std::unique_ptr<AnyGuard> guarded(const Scene& scene,
                                  const taut::GuardedOptions<double>& options = {});
/// By a call: Laws::hookean of 1d and float 2d, Laws::strings of double 2d and of 3d, Laws::any of
/// double 3d; with a response in 3d.
std::unique_ptr<AnyGuard> guarded(const Scene& scene, Trial trial);

constexpr Kind any3{false, 3, Laws::any};
/// Two particles of 1 kg, one at the origin, and a Hookean spring of 1 m.
Scene pair(const Eigen::Vector3d& other, double stiffness, double damping = 0);
/// Where a cloth hangs after 20 s with drag, without velocity.
AnyState at_rest(Scene scene);

}  // namespace taut_test
