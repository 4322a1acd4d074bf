// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>
#include <taut/core/types.hpp>
#include <vector>

// Which vertices --pin, --pin-box and --pin-top name.

namespace example {

using taut::Index;

/// "3,7,10-20" as numbers. Throws naming --pin and the part that is wrong.
inline std::vector<Index> parse_pins(const std::string& list) {
    std::vector<Index> pins;
    std::stringstream parts(list);
    for (std::string part; std::getline(parts, part, ',');) {
        Index first = -1;
        Index last = -1;
        const char* end = part.data() + part.size();
        auto read = std::from_chars(part.data(), end, first);
        last = first;
        if (read.ec == std::errc() && read.ptr != end && *read.ptr == '-') {
            read = std::from_chars(read.ptr + 1, end, last);
        }
        if (read.ec != std::errc() || read.ptr != end || first < 0 || last < first ||
            last - first > 10'000'000) {
            throw std::runtime_error("--pin: \"" + part +
                                     "\" is not a vertex number or a range like 10-20");
        }
        for (Index pin = first; pin <= last; ++pin) pins.push_back(pin);
    }
    return pins;
}

/// The vertices in the box between two corners, its faces included; of those that `is_used`.
/// Throws where there are none.
template <class IsUsed>
std::vector<Index> vertices_in_box(const taut::Points<double, 3>& x,
                                   const std::vector<double>& corners, const IsUsed& is_used) {
    const Eigen::Map<const Eigen::Vector3d> one(corners.data()), other(corners.data() + 3);
    const Eigen::Array3d low = one.cwiseMin(other).array(), high = one.cwiseMax(other).array();
    std::vector<Index> found;
    for (Index v = 0; v < x.cols(); ++v) {
        const auto at = x.col(v).array();
        if (is_used(v) && (at >= low).all() && (at <= high).all()) found.push_back(v);
    }
    if (found.empty()) {
        const auto point = [](const Eigen::Vector3d& p) {
            char text[96];
            std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", p[0], p[1], p[2]);
            return std::string(text);
        };
        throw std::runtime_error("--pin-box: no vertex is in it; the mesh reaches from " +
                                 point(x.rowwise().minCoeff()) + " to " +
                                 point(x.rowwise().maxCoeff()));
    }
    return found;
}

/// The given share of the vertices that `is_used`, at least one, highest along `up`; those as high
/// as the lowest of them too, but for rounding.
template <class IsUsed>
std::vector<Index> highest_vertices(const taut::Points<double, 3>& x, const Eigen::Vector3d& up,
                                    double share, const IsUsed& is_used) {
    std::vector<Index> order;
    for (Index v = 0; v < x.cols(); ++v)
        if (is_used(v)) order.push_back(v);
    if (share == 0 || order.empty()) return {};
    const Eigen::RowVectorXd height = up.transpose() * x;
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return height[a] > height[b]; });
    const auto count = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::floor(share * static_cast<double>(order.size()) + 1e-9)));
    const double range = height[order.front()] - height[order.back()];
    const double least = height[order[count - 1]] - 1e-9 * range;
    const auto end =
        std::find_if(order.begin(), order.end(), [&](Index v) { return height[v] < least; });
    if (end == order.end() && count < order.size()) {
        throw std::runtime_error(
            "--pin-top: all vertices are as high as the highest; --up names another axis");
    }
    order.erase(end, order.end());
    return order;
}

}  // namespace example
