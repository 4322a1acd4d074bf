// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "../lanczos.hpp"

namespace taut::proof_detail {

/// What one vector says of a system: enclosures of uᵀKu/uᵀMu, 1/s², and uᵀDu/uᵀMu, 1/s.
struct Quotients {
    Enclosed k;
    Enclosed d;
};

/// @param stiffness  K or K_plus
inline Quotients quotients(const Pencil& pencil, const Eigen::VectorXd& u,
                           const Combination& stiffness) {
    const Enclosed m = pencil.quadratic(M, u);
    const auto over_m = [&](const Enclosed& q) {
        const double value = q.value / m.value;
        const double error = (q.error + m.error * (std::abs)(value)) / m.lower();
        if (!detail::is_finite(value + error)) return Enclosed{0, infinity};  // it says nothing
        return Enclosed{value, error};
    };
    return {over_m(pencil.quadratic(stiffness, u)), over_m(pencil.quadratic(D, u))};
}

/// The smallest eigenvalue of K'⁺ from above. The softest modes are smooth, so the search begins
/// with the translation along an axis that costs least (none at all on a mechanism).
template <class Real = double>
RitzPair softest(const Pencil& pencil) {
    LanczosOptions options;
    options.basis = 48;
    Eigen::VectorXd start;
    Enclosed least{infinity, 0};
    for (Index axis = 0; axis < pencil.dim(); ++axis) {
        Eigen::VectorXd u = Eigen::VectorXd::Zero(pencil.size());
        for (Index i = axis; i < u.size(); i += pencil.dim()) u[i] = 1;
        const Enclosed k = quotients(pencil, u, K_plus).k;
        if (k.value < least.value) {
            least = k;
            start = std::move(u);
        }
    }
    // On a mechanism of springs rounding hides what a search would find.
    if (least.value <= least.error && pencil.projected_semidefinite()) {
        start /= std::sqrt(pencil.quadratic(M, start).value);
        return {least.value, least.error, std::move(start), 0};
    }
    return largest_ritz_pair(pencil, -K_plus, options, start);
}

}  // namespace taut::proof_detail
