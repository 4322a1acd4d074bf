// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../accuracy/accuracy.hpp"
#include "../recommend/candidate.hpp"

namespace taut {

/// Cost and error of one way to simulate a scene.
struct TradeoffPoint {
    std::string name;
    Candidate candidate;    ///< h as taken; of a stepper of the caller's, h alone
    Index steps = 0;        ///< taken, or asked for where the stepper chooses its own
    bool finished = false;  ///< no step failed and all is finite
    double cost = 0;        ///< CPU s for a simulated s
    double position_error = std::numeric_limits<double>::infinity();  ///< see position_error()
    double energy_drift = std::numeric_limits<double>::infinity();    ///< see energy_drift()
    /// Of the lowest modes of the linearised scene; nothing where the steps do not swing.
    std::vector<std::optional<ModeError>> modes;
};

/// The points that no other one beats in both cost and position error, the cheapest first.
inline std::vector<TradeoffPoint> pareto(std::vector<TradeoffPoint> points) {
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.position_error < b.position_error;
    });
    std::vector<TradeoffPoint> front;
    double best = std::numeric_limits<double>::infinity();
    for (auto& point : points) {
        if (!point.finished || !(point.position_error < best)) continue;
        best = point.position_error;
        front.push_back(std::move(point));
    }
    return front;
}

}  // namespace taut
