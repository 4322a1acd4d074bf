// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <taut/taut.hpp>
#include <vector>

#include "base64.hpp"
#include "near_limit.hpp"
#include "findings.hpp"
#include "scene.hpp"

// What the HTML page draws beside the findings: multipliers, the damping window, the mesh with its
// limiting springs, and the two runs.

namespace example {

/// To a millionth: what is drawn needs no more digits.
inline double rounded(double value) { return std::round(1e6 * value) / 1e6; }

/// The multipliers of symplectic Euler at h: of the limiting mode and, with Rayleigh damping, of
/// every stiffness from 0 to that mode's.
inline Json multipliers_json(const taut::Mode& mode,
                             const std::optional<taut::RayleighDamping>& rayleigh, double h) {
    constexpr int samples = 240;
    const auto pair = [&](double k, double d) {
        Json roots;
        for (const auto& mu : taut::multipliers(Method::symplectic_euler, k, d, h))
            roots.push_back({rounded(mu.real()), rounded(mu.imag())});
        return roots;
    };
    Json json{{"h", h},
              {"radius", taut::spectral_radius(Method::symplectic_euler, mode.k, mode.d, h)},
              {"limiting", pair(mode.k, mode.d)},
              {"others", Json::array()}};
    if (!rayleigh) return json;
    for (int i = 0; i < samples; ++i) {
        const double k = mode.k * std::pow(double(i) / samples, 2);  // even in the angle
        const double d = rayleigh->mass_proportional + rayleigh->stiffness_proportional * k;
        if (k > 0 || d > 0) json["others"].push_back(pair(k, d));
    }
    return json;
}

/// The proved window of α at steps from 1/30 of 2/√k_max to a little above it.
inline Json window_json(const taut::Stability<double>& stability, const Findings& found,
                        double d0) {
    constexpr int samples = 160;
    const double k_max = found.spectrum.k_max.upper;
    const auto& pencil = stability.pencil();
    const double compression =
        pencil.stiffness_semidefinite() ? 0 : std::max(0.0, pencil.upper_bound(-taut::matrices::K));
    const double longest = 2 / std::sqrt(k_max);
    Json json{{"d0", d0}, {"k_max", k_max}, {"longest", longest}, {"h", Json::array()}};
    for (int i = 0; i <= samples; ++i) {
        const double h = longest * std::pow(30, double(i) / samples - 1);
        json["h"].push_back(h);
        for (const Method method : {Method::explicit_euler, Method::symplectic_euler}) {
            // At the end itself the window has closed; just below it is still open.
            const auto window = taut::rayleigh_window(method, i < samples ? h : h * (1 - 1e-9), d0,
                                                      0, k_max, compression);
            const bool empty = window.empty != taut::EmptyWindow::none;
            json[name(method)].push_back(
                empty ? Json(nullptr) : Json{window.lower, window.upper, window.includes_zero});
        }
    }
    return json;
}

/// @param rayleigh  of the system, if Rayleigh damping is all it has
inline Json page_data(const taut::Stability<double>& stability, const Findings& found,
                      const taut::Mode& mode,
                      const std::optional<taut::RayleighDamping>& rayleigh) {
    Json json;
    json["multipliers"] = nullptr;
    json["window"] = nullptr;
    json["mesh"] = nullptr;
    json["runs"] = nullptr;
    const auto& limit = found.symplectic_euler;
    if (limit.certified > 0 && std::isfinite(limit.certified) && std::isfinite(limit.refuted)) {
        json["multipliers"] = {
            {"below", multipliers_json(mode, rayleigh, below_limit * limit.certified)},
            {"above", multipliers_json(mode, rayleigh, above_limit * limit.refuted)}};
    }
    const double k_max = found.spectrum.k_max.upper;
    if (k_max > 0 && std::isfinite(k_max))
        json["window"] = window_json(stability, found, rayleigh ? rayleigh->mass_proportional : 0);
    return json;
}

/// Triangles, a line as one without area, and the springs that hold at least a thousandth of what
/// the foremost one holds.
inline void add_mesh(Json& page, const Scene& scene, const taut::Stability<double>& stability,
                     const taut::Mode& mode) {
    constexpr std::size_t most_springs = 20'000;
    const auto x = scene.system.initial_state().x;
    const int width = scene.system.size() < 65536 ? 2 : 4;
    const Eigen::Vector3d low = x.rowwise().minCoeff();
    const double extent = std::max((x.rowwise().maxCoeff() - low).maxCoeff(), 1e-300);
    std::vector<std::uint8_t> positions, triangles, springs, pinned;
    for (taut::Index i = 0; i < x.cols(); ++i) {
        for (int d = 0; d < 3; ++d) {
            append(positions, std::uint64_t(std::lround((x(d, i) - low[d]) / extent * 65535)), 2);
        }
        if (scene.system.is_pinned(i)) append(pinned, std::uint64_t(i), width);
    }
    for (const auto& face : scene.faces) {
        const std::size_t last = face.size() - 1;
        for (std::size_t i = 1; i < std::max<std::size_t>(2, last); ++i) {
            for (const auto corner : {face[0], face[i], face[std::min(i + 1, last)]})
                append(triangles, std::uint64_t(corner), width);
        }
    }
    std::vector<taut::SpringShare> shares;
    if (mode.shape.size() > 0) shares = stability.pencil().spring_shares(mode.shape);
    std::sort(shares.begin(), shares.end(),
              [](const auto& p, const auto& q) { return p.share > q.share; });
    Json share = Json::array();
    for (const auto& spring : shares) {
        const double relative = spring.share / shares.front().share;
        if (!(relative > 1e-3) || share.size() == most_springs) break;
        append(springs, std::uint64_t(spring.a), width);
        append(springs, std::uint64_t(spring.b), width);
        share.push_back(rounded(relative));
    }
    const Eigen::Vector3d g = scene.system.gravity().cwiseAbs();
    page["name"] = scene.name;
    page["mesh"] = {{"index_bytes", width},
                    {"extent", extent},
                    {"up", g[2] > g[1] ? 2 : 1},
                    {"positions", base64(positions)},
                    {"triangles", base64(triangles)},
                    {"pinned", base64(pinned)},
                    {"springs", base64(springs)},
                    {"foremost", shares.empty() ? 0 : shares.front().share},
                    {"share", share}};  // of the foremost one's
}

/// A displacement in four bytes: direction, and its length on a logarithmic scale from `floor` to
/// `ceiling`, m; four zeros are none.
inline std::array<std::uint8_t, 4> quantised(const Eigen::Vector3d& u, double floor,
                                             double ceiling) {
    const double length = u.norm();
    if (!(length >= floor)) return {};
    const double fraction = std::min(1.0, std::log(length / floor) / std::log(ceiling / floor));
    std::array<std::uint8_t, 4> bytes{};
    for (int d = 0; d < 3; ++d)
        bytes[d] = static_cast<std::uint8_t>(std::lround(127 * u[d] / length) & 0xff);
    bytes[3] = static_cast<std::uint8_t>(1 + std::lround(254 * fraction));
    return bytes;
}

inline Json run_json(const KickedRun& run, const std::vector<taut::Index>& moved, double floor,
                     double ceiling) {
    std::vector<std::uint8_t> bytes;
    for (const auto& frame : run.frames) {
        for (const auto i : moved) {
            const auto four = quantised(frame.col(i), floor, ceiling);
            bytes.insert(bytes.end(), four.begin(), four.end());
        }
    }
    return {{"h", run.h},
            {"steps", run.reach.size() - 1},
            {"reach", run.reach},
            {"frames", run.frames.size()},
            {"displacement", base64(bytes)}};
}

/// The runs at 0.99 of the certified and 1.01 of the refuted step, without gravity, so that the
/// pose is at rest and nothing but the step moves it.
inline void add_runs(Json& page, const Scene& scene, const taut::StepLimit<double>& limit,
                     const taut::Mode& mode) {
    if (page["multipliers"].is_null()) return;
    System still = scene.system;
    still.set_gravity({0, 0, 0});
    const auto [kick, speed, above, below] = run_near_limit(still, mean_edge(scene), limit, mode);
    if (!(kick > 0)) return;  // all particles in one point
    const double floor = kick / 100;
    const double ceiling = diagonal(scene);
    std::vector<taut::Index> moved;  // others would be drawn where they are
    for (taut::Index i = 0; i < still.size(); ++i) {
        const auto moves = [&](const auto& frame) { return frame.col(i).norm() >= floor; };
        if (std::any_of(above.frames.begin(), above.frames.end(), moves) ||
            std::any_of(below.frames.begin(), below.frames.end(), moves))
            moved.push_back(i);
    }
    const std::size_t stride = frame_stride(above.frames.size(), moved.size());
    const int width = still.size() < 65536 ? 2 : 4;
    std::vector<std::uint8_t> indices;
    for (const auto i : moved) append(indices, std::uint64_t(i), width);
    page["runs"] = {{"kick", kick},
                    {"speed", speed},
                    {"steps_a_frame", stride * KickedRun::steps_a_frame},
                    {"floor", floor},
                    {"ceiling", ceiling},
                    {"moved", base64(indices)},
                    {"below", run_json(every(below, stride), moved, floor, ceiling)},
                    {"above", run_json(every(above, stride), moved, floor, ceiling)}};
}

}  // namespace example
