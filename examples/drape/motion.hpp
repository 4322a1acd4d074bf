// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "obstacle.hpp"
#include "plan.hpp"

namespace drape {

/// Advances by a frame. Empty, or what went wrong.
using Advance = std::function<std::string(State&)>;

/// What a motion is made of; cloth and obstacle must outlive it.
struct Scene {
    const Cloth& cloth;
    const Obstacle& obstacle;
    const Plan& plan;
};

/// implicit, newton, bdf2 and projective.
Advance make_implicit_motion(const Options& options, const Scene& scene);

}  // namespace drape
