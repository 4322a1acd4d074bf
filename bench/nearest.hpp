// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace bench {

/// How near the way from a to b comes to the origin, m.
inline float nearest(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    const Eigen::Vector3f way = b - a;
    const float share = -a.dot(way) / std::max(way.squaredNorm(), 1e-12f);
    return (a + std::clamp(share, 0.0f, 1.0f) * way).norm();
}

}  // namespace bench
