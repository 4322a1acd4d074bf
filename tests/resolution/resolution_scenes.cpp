// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "resolution_scenes.hpp"

#include <taut/resolution/resolution.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/wind/wind.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/scene_of.hpp"

namespace taut_test::resolution {

const std::vector<Kind> kinds = {{true, 1},
                                 {true, 2, Laws::mixed},
                                 {true, 3},
                                 {true, 2, Laws::strings},
                                 {false, 1},
                                 {false, 2},
                                 {false, 3},
                                 {false, 3, Laws::strings},
                                 {false, 3, Laws::mixed}};

namespace {

template <class Visit>
void visit_kind(const Scene& scene, Visit&& visit) {
    visit_system<Plain<float, 1>, Mixed<float, 2>, Plain<float, 3>, Plain<double, 1>,
                 Plain<double, 2>, Plain<double, 3>, Strings<double, 3>, Strings<float, 2>,
                 Mixed<double, 3>>(scene, visit);
}

template <class System>
AnyCoarsening to_any(taut::Coarsening<System> made) {
    using State = typename System::State;
    AnyCoarsening any{scene_of(made.system), made.seeds, made.cluster, {}, {}};
    const auto kept = std::make_shared<const taut::Coarsening<System>>(std::move(made));
    any.restricted = [kept](const AnyState& fine) {
        return taut_test::to_any(kept->restricted(from_any<State>(fine)));
    };
    any.lifted = [kept](const Eigen::MatrixXd& moved) -> Eigen::MatrixXd {
        return kept->lifted(moved.cast<typename System::Scalar>()).template cast<double>();
    };
    return any;
}

}  // namespace

AnyCoarsening coarsen(const Scene& scene, Index count) {
    std::optional<AnyCoarsening> made;
    visit_kind(scene,
               [&](const auto& system) { made.emplace(to_any(taut::coarsen(system, count))); });
    return *std::move(made);
}
Index least_count(const Scene& scene) {
    Index least = 0;
    visit_kind(scene, [&](const auto& system) { least = taut::least_count(system); });
    return least;
}
Scene as_strings(const Scene& scene) {
    Scene strings({false, 3, Laws::strings});
    visit_system<Plain<double, 3>>(scene, [&](const auto& system) {
        strings = scene_of(taut::with_law<TensionOnly>(system));
    });
    return strings;
}
void set_wind(const Scene& scene, const std::vector<taut::Triangle>& triangles) {
    visit_system<Plain<double, 3>>(scene, [&](auto& system) {
        taut::Wind<double> wind;
        wind.triangles = triangles;
        taut::set_wind(system, wind);
    });
}

AnyResolution resolve(const Scene& scene, const AnyState& state, double duration, double goal,
                      const taut::ResolveOptions& options) {
    AnyResolution any;
    visit_system<Plain<double, 2>, Plain<double, 3>, Plain<float, 3>, Strings<double, 3>>(
        scene, [&](const auto& system) {
            using State = typename std::decay_t<decltype(system)>::State;
            auto found = taut::resolve(system, from_any<State>(state), duration, goal, options);
            any.outcome = found.outcome;
            any.levels = found.levels;
            any.chosen = found.chosen;
            any.size = found.size;
            any.fine_cost = found.fine_cost;
            any.search_cost = found.search_cost;
            any.floor = found.floor;
            any.why = found.why;
            any.cheaper = found.cheaper();
            if (found.coarsening) any.coarse = to_any(*std::move(found.coarsening));
        });
    return any;
}

}  // namespace taut_test::resolution
