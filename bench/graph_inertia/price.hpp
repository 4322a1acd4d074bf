// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <optional>
#include <taut/graph_inertia/graph_inertia.hpp>
#include <taut/graph_inertia/inertia_price.hpp>

#include "../measure.hpp"
#include "scenes.hpp"

namespace bench::graph_inertia {

/// Positions at the end of each frame, and the least time of a frame, ms.
struct Frames {
    std::vector<taut::Points<double, 3>> x;
    double least = 1e300;
};

/// Frames of `substeps` steps each.
template <class Stepper>
std::optional<Frames> simulate(const Net& net, Stepper&& stepper, Index substeps, int count) {
    Frames frames;
    auto state = net.initial_state();
    for (int f = 0; f < count; ++f) {
        const double start = now(thread_time);
        if (!stepper.step(state, frame / static_cast<double>(substeps), substeps)) return {};
        frames.least = std::min(frames.least, now(thread_time) - start);
        frames.x.push_back(state.x);
    }
    return frames;
}

/// Beside a reference, relative to the largest displacement of a particle.
struct Error {
    double rms = 0, most = 0;
};

inline Error error_of(const Frames& frames, const Frames& reference, const Net& net) {
    const auto start = net.initial_state().x;
    double way = 0, square = 0;
    Error error;
    for (std::size_t f = 0; f < frames.x.size(); ++f) {
        const auto difference = (frames.x[f] - reference.x[f]).eval();
        way = std::max(way, (reference.x[f] - start).colwise().norm().maxCoeff());
        error.most = std::max(error.most, difference.colwise().norm().maxCoeff());
        square += difference.squaredNorm();
    }
    const auto points = static_cast<double>(frames.x.size() * static_cast<std::size_t>(net.size()));
    error.rms = std::sqrt(square / points) / way;
    error.most /= way;
    return error;
}

/// The fewest steps a frame that touch at most `share` of the particles.
inline Index fewest_that_touch(const Net& net, double share, Index substeps) {
    Index low = 1, high = substeps;
    while (low + 1 < high) {
        const Index n = (low + high) / 2;
        const auto shares = taut::graph_shares(net, frame / static_cast<double>(n),
                                               taut::GraphInertiaOptions{}.margin);
        const bool few = static_cast<double>(taut::touched_particles(net, shares)) <=
                         share * static_cast<double>(net.size());
        (few ? high : low) = n;
    }
    return high;
}

/// A line of the table.
struct Price {
    Index n = 0, touched = 0;
    double prepare = 0, least = 0, added = 0;
    Error error;
};

inline std::optional<Price> price(const Net& net, Index n, const Frames& reference,
                                  const taut::GraphInertiaOptions& options) {
    Price price;
    price.n = n;
    const double h = frame / static_cast<double>(n);
    taut::GraphInertia stepper(net, options);
    const double start = now(thread_time);
    if (!stepper.prepare(h)) return {};
    price.prepare = now(thread_time) - start;
    price.touched = stepper.touched();
    price.added = taut::inertia_price(net, net.initial_state(), stepper.shares(), 0).added;
    const auto frames = simulate(net, stepper, n, static_cast<int>(reference.x.size()));
    if (!frames) return {};
    price.least = frames->least;
    price.error = error_of(*frames, reference, net);
    return price;
}

/// One scene: an explicit line, then graph inertia by several numbers of steps; the cheapest within
/// the bound is bold.
inline void price_scene(const Scene& scene, const taut::GraphInertiaOptions& options) {
    const Net& net = scene.net;
    const int count = scene.frames;
    const double limit = taut::any_pose_limit(net).certified;
    const auto substeps = static_cast<Index>(std::ceil(frame / limit));
    taut::VelocityVerlet fine(net);
    const auto reference = simulate(net, fine, 4 * substeps, count);
    taut::SymplecticEuler symplectic(net);
    const auto plain = simulate(net, symplectic, substeps, count);
    if (!reference || !plain) {
        std::printf("| %s | failed |\n", scene.name.c_str());
        return;
    }
    const Error error = error_of(*plain, *reference, net);
    std::printf("| %s: %ld particles | explicit, %ld | | | %.2f | 1 | %.3f | %.2f | |\n",
                scene.name.c_str(), static_cast<long>(net.size()), static_cast<long>(substeps),
                plain->least, 100 * error.rms, 100 * error.most);
    std::vector<Index> steps;
    for (double n = 8; n < static_cast<double>(substeps); n *= 1.5)
        steps.push_back(static_cast<Index>(n));
    for (const double share : {0.05, 0.1, 0.3})
        steps.push_back(fewest_that_touch(net, share, substeps));
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    std::vector<Price> prices;
    for (const Index n : steps) {
        if (const auto found = price(net, n, *reference, options)) prices.push_back(*found);
    }
    const Price* best = nullptr;
    for (const auto& p : prices) {
        if (p.error.rms <= scene.bound && (!best || p.least < best->least)) best = &p;
    }
    for (const auto& p : prices) {
        const char* mark = &p == best ? "**" : "";
        std::printf("| | %s%ld%s | %ld | %.1f | %.2f | %s%.3f%s | %s%.3f%s | %.2f | %.3g |\n", mark,
                    static_cast<long>(p.n), mark, static_cast<long>(p.touched), p.prepare, p.least,
                    mark, p.least / plain->least, mark, mark, 100 * p.error.rms, mark,
                    100 * p.error.most, 100 * p.added);
    }
    std::fflush(stdout);
}

}  // namespace bench::graph_inertia
