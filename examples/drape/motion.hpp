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

/// The motions whose steps solve linear systems, by the solver of --solver. Each is compiled by
/// itself.
Advance motion_by_cholesky(const Options& options, const Scene& scene);
Advance motion_by_gradients(const Options& options, const Scene& scene);
#ifdef DRAPE_CHOLMOD
Advance motion_by_cholmod(const Options& options, const Scene& scene);
#endif

}  // namespace drape
