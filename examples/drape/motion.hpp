// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <taut/guard/report.hpp>

#include "obstacle.hpp"
#include "plan.hpp"

namespace drape {

struct Advanced {
    std::string trouble;  // empty, or what went wrong
    taut::Taken taken = taut::Taken::tried;
};

/// Advances by a frame.
using Advance = std::function<Advanced(State&)>;

/// What a motion is made of; cloth and obstacle must outlive it.
struct Scene {
    const Cloth& cloth;
    const Obstacle& obstacle;
    const Plan& plan;
};

}  // namespace drape
