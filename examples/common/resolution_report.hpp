// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "base64.hpp"
#include "findings.hpp"
#include "number.hpp"
#include "scene.hpp"

// How few particles would do: what stability_report --resolve prints, writes and draws.

namespace example {

inline void print_resolution(const ResolutionFound& told) {
    const auto& found = told.found;
    std::printf("Positions within %.3g %% of the scene's size for %.3g s: how few particles?\n",
                100 * found.goal, told.duration);
    if (!found.levels.empty())
        std::printf("  particles   springs   certified step   cost of all   error\n");
    for (const auto& level : found.levels) {
        char error[32] = "compared with";
        if (std::isfinite(level.error))
            std::snprintf(error, sizeof error, "%.2g %%", 100 * level.error);
        std::printf("  %9lld %9lld   %12s s   %11.3g   %s\n",
                    static_cast<long long>(level.particles), static_cast<long long>(level.springs),
                    rounded_down(level.h, 5).c_str(), level.cost / found.fine_cost, error);
    }
    std::printf("  %s\n", found.why.c_str());
    if (told.measured)
        std::printf("  The scene itself was run, too: they are off by %.2g %%.\n",
                    100 * *told.measured);
    if (found.chosen >= 0 && !told.measured)
        std::printf("  The errors are estimates; the steps are certified.\n");
}

inline Json resolution_json(const ResolutionFound& told) {
    const auto& found = told.found;
    Json json{{"goal", found.goal},
              {"duration", told.duration},
              {"outcome", name(found.outcome)},
              {"particles", nullptr},
              {"estimated_error", nullptr},
              {"measured_error", told.measured ? Json(*told.measured) : Json(nullptr)},
              {"cheaper", found.cheaper()},
              {"floor", found.floor},
              {"search_cost", found.fine_cost > 0 ? found.search_cost / found.fine_cost : 0},
              {"why", found.why},
              {"levels", Json::array()}};
    if (found.chosen >= 0) {
        const auto& level = found.levels[static_cast<std::size_t>(found.chosen)];
        json["particles"] = level.particles;
        json["estimated_error"] = level.error;
    }
    for (const auto& level : found.levels) {
        json["levels"].push_back(
            {{"particles", level.particles},
             {"springs", level.springs},
             {"h", level.h},
             {"cost", level.cost / found.fine_cost},
             {"error", std::isfinite(level.error) ? Json(level.error) : Json(nullptr)}});
    }
    return json;
}

namespace detail {

/// The motion of a system at even times, the first of them the start.
inline std::vector<taut::Points<double, 3>> motion(const System& system, System::State state,
                                                   double duration, int frames) {
    const double interval = duration / frames;
    const double most = taut::energy_limit(system).certified;
    const auto steps = static_cast<taut::Index>(std::max(1.0, std::ceil(interval / most)));
    taut::EnergyStableEuler stepper(system);
    std::vector<taut::Points<double, 3>> path{state.x};
    for (int frame = 0; frame < frames; ++frame) {
        if (!stepper.step(state, interval / static_cast<double>(steps), steps)) break;
        path.push_back(state.x);
    }
    return path;
}

/// Displacements from the first, in two bytes a coordinate, as shares of `most`.
inline Json film(const std::vector<taut::Points<double, 3>>& path, double most) {
    std::vector<std::uint8_t> bytes;
    for (const auto& x : path) {
        const taut::Points<double, 3> moved = (x - path.front()) / most;
        for (Eigen::Index i = 0; i < moved.size(); ++i) {
            const auto value = std::lround(32767 * std::clamp(moved.data()[i], -1.0, 1.0));
            append(bytes, static_cast<std::uint64_t>(value) & 0xffffU, 2);
        }
    }
    return base64(bytes);
}

}  // namespace detail

/// Runs the scene itself, where that takes some ten seconds at most, and the chosen network, lifted
/// onto the scene's mesh; measures how far they are apart.
inline void add_resolution(Json& page, const Scene& scene, ResolutionFound& told) {
    constexpr double affordable = 3e9;  // spring-steps
    constexpr double bytes = 1.1e6;     // of both films
    const auto& found = told.found;
    page["resolution"] = resolution_json(told);
    page["resolution"]["films"] = nullptr;
    if (!found.coarsening || found.fine_cost > affordable) return;
    const auto state = scene.system.initial_state();
    const auto each = 12.0 * static_cast<double>(scene.system.size());
    const int frames = static_cast<int>(std::clamp(bytes / each, 1.0, 30.0));
    const auto fine = detail::motion(scene.system, state, told.duration, frames);
    const auto few = detail::motion(found.coarsening->system, found.coarsening->restricted(state),
                                    told.duration, frames);
    if (fine.size() != few.size()) return;
    std::vector<taut::Points<double, 3>> lifted;
    double most = 1e-300, apart = 0;
    for (std::size_t f = 0; f < fine.size(); ++f) {
        lifted.push_back(fine[0] + found.coarsening->lifted(few[f] - few[0]));
        most = std::max({most, (fine[f] - fine[0]).cwiseAbs().maxCoeff(),
                         (lifted[f] - fine[0]).cwiseAbs().maxCoeff()});
        apart = std::max(apart, std::sqrt((fine[f] - lifted[f]).colwise().squaredNorm().mean()));
    }
    told.measured = apart / found.size;
    page["resolution"] = resolution_json(told);
    page["resolution"]["films"] = {{"frames", fine.size()},
                                   {"most", most},
                                   {"size", found.size},
                                   {"fine", detail::film(fine, most)},
                                   {"coarse", detail::film(lifted, most)},
                                   {"seeds", found.coarsening->seeds}};
}

}  // namespace example
