// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "parts.hpp"

namespace taut::guard_detail {

/// A part's gain of energy, J, as far as it may be trimmed away.
struct Gain {
    double left = 0;
    double speed = 0;                       ///< Σ m|v|², J: its rounding is trimmed, too
    double slope = 0, curve = 0, step = 0;  ///< A, B and g of A g − ½B g²
};

/// Takes gains off the end velocities by axial damping, v ← v − g M⁻¹D with D = GV, G = Σ k n nᵀ
/// over the springs [T43]: at most 4 times, each with g ≤ h²/4. Without pins both momenta are kept.
/// @param any_pose  h, s   @param gains  of each part; what is not > 0 is let be
/// @param D         memory, overwritten
/// @returns whether anything was changed
template <class System>
bool trim(const System& system, typename System::State& state, const Parts& parts, double any_pose,
          std::vector<Gain>& gains, typename System::Force& D) {
    using Scalar = typename System::Scalar;
    using Vector = typename System::Vector;
    constexpr double unit = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    const auto wanted = [&](Index part) {
        return part >= 0 && gains[static_cast<std::size_t>(part)].left > 0;
    };
    bool changed = false;
    D.resize(Eigen::NoChange, system.size());
    for (int pass = 0; pass < 4; ++pass) {
        D.setZero();
        system.visit_springs([&](const auto& spring) {
            if (!wanted(parts.of(spring.a, spring.b))) return;
            const Vector dx = state.x.col(spring.b) - state.x.col(spring.a);
            const Vector dv = state.v.col(spring.b) - state.v.col(spring.a);
            const Vector n = dx / spring_length(dx);
            const Vector f = spring.stiffness_bound() * n.dot(dv) * n;
            D.col(spring.b) += f;
            D.col(spring.a) -= f;
        });
        for (auto& gain : gains) gain.slope = gain.curve = gain.step = 0;
        for (Index i = 0; i < system.size(); ++i) {
            if (!wanted(parts.of(i))) continue;
            auto& line = gains[static_cast<std::size_t>(parts.of(i))];
            line.slope += static_cast<double>(D.col(i).dot(state.v.col(i)));
            line.curve += static_cast<double>(D.col(i).squaredNorm() * system.inverse_mass()[i]);
        }
        bool any = false;
        for (std::size_t p = 0; p < gains.size(); ++p) {
            if (!(gains[p].left > 0)) continue;
            const double A = gains[p].slope, B = gains[p].curve;
            if (!(A > 0) || !(B > 0) || !detail::is_finite(A + B)) {
                gains[p].left = 0;  // nothing to be had
                continue;
            }
            const double aim = gains[p].left * (1 + 1e-6) + 4 * unit * gains[p].speed;
            double g = (std::min)(any_pose * any_pose / 4, A / B);
            if (A * A >= 2 * B * aim) {
                g = (std::min)(g, 2 * aim / (A + std::sqrt(A * A - 2 * B * aim)));
            }
            gains[p].step = g;
            gains[p].left -= A * g - B * g * g / 2;
            any = true;
        }
        if (!any) break;
        changed = true;
        for (Index i = 0; i < system.size(); ++i) {
            if (parts.of(i) < 0) continue;
            const double g = gains[static_cast<std::size_t>(parts.of(i))].step;
            if (g > 0)
                state.v.col(i) -= static_cast<Scalar>(g) * system.inverse_mass()[i] * D.col(i);
        }
    }
    return changed;
}

}  // namespace taut::guard_detail
