// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <taut/resolution/levels.hpp>

#include "../support/scene.hpp"

// coarsen() and resolve() for scenes.

namespace taut_test::resolution {

/// The kinds that there are a coarsen() for: each law, each dimension, float and double.
extern const std::vector<Kind> kinds;

struct AnyCoarsening {
    Scene system;
    std::vector<int> seeds;
    std::vector<int> cluster;
    std::function<AnyState(const AnyState&)> restricted;
    std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)> lifted;
};
AnyCoarsening coarsen(const Scene& scene, Index count);
Index least_count(const Scene& scene);
/// Of a plain scene in three dimensions.
Scene as_strings(const Scene& scene);
/// Of a plain scene in three dimensions; of no triangles: ends the wind.
void set_wind(const Scene& scene, const std::vector<taut::Triangle>& triangles);

/// Hookean springs in two and three dimensions, TensionOnly in three; float in three alone.
struct AnyResolution : taut::Resolution<taut::SpringSystem<double, 3>> {
    std::optional<AnyCoarsening> coarse;  ///< in place of coarsening
    double cheaper = 1;
};
AnyResolution resolve(const Scene& scene, const AnyState& state, double duration, double goal,
                      const taut::ResolveOptions& options = {});

}  // namespace taut_test::resolution
