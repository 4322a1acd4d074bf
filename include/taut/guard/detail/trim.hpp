// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "parts.hpp"

namespace taut::guard_detail {

/// Takes energy off end velocities by damping along the springs: v ← v − g M⁻¹D, D = GV with
/// G = Σ k n nᵀ and pins with their velocity in V, takes Ag − ½Bg², A = vᵀD, B = DᵀM⁻¹D [T43].
template <class System>
class Trim {
public:
    /// Takes `excess(part)`, J, off each part where that is > 0, if four passes can.
    /// @param longest  g at most, s²
    template <class Excess>
    void operator()(const System& system, typename System::State& state, double longest,
                    Parts<System>& parts, const Excess& excess) {
        sums_.clear();
        for (const auto& part : parts) sums_.push_back({excess(part), 0, 0, 0});
        for (int pass = 0; pass < 4; ++pass) {
            if (!find_direction(system, state, parts)) return;
            for (auto& sum : sums_) {
                if (!(sum.excess > 0)) continue;
                if (!(sum.along > 0)) {
                    sum.excess = 0;
                    continue;
                }
                sum.g = std::min(longest, sum.along / sum.square);
                const double root = sum.along * sum.along - 2 * sum.square * sum.excess;
                if (root >= 0)
                    sum.g = std::min(sum.g, 2 * sum.excess / (sum.along + std::sqrt(root)));
                sum.excess -= sum.along * sum.g - sum.square * sum.g * sum.g / 2;
            }
            for (Index i = 0; i < system.size(); ++i) {
                const int part = parts.of(i);
                if (part < 0 || !(sums_[part].g > 0)) continue;
                state.v.col(i) -=
                    (sums_[part].g / static_cast<double>(system.mass(i)) * direction_.col(i))
                        .template cast<typename System::Scalar>();
            }
        }
    }

private:
    struct Sum {
        double excess, along, square, g;  // J, A, B, s²
    };

    /// D, A and B. @returns whether there is excess left
    bool find_direction(const System& system, const typename System::State& state,
                        Parts<System>& parts) {
        bool left = false;
        for (auto& sum : sums_) {
            left = left || sum.excess > 0;
            sum.along = sum.square = sum.g = 0;
        }
        if (!left) return false;
        direction_.setZero(System::Dim, system.size());
        system.visit_springs([&](const auto& spring) {
            const int part = parts.of(spring.a, spring.b);
            if (part < 0 || !(sums_[part].excess > 0)) return;
            const Vector dx =
                (state.x.col(spring.b) - state.x.col(spring.a)).template cast<double>();
            const Vector dv =
                (state.v.col(spring.b) - state.v.col(spring.a)).template cast<double>();
            const double l2 = dx.squaredNorm();
            if (!(l2 > 0)) return;
            const Vector D = static_cast<double>(spring.stiffness_bound()) * dx.dot(dv) / l2 * dx;
            direction_.col(spring.b) += D;
            direction_.col(spring.a) -= D;
        });
        for (Index i = 0; i < system.size(); ++i) {
            const int part = parts.of(i);
            if (part < 0 || !(sums_[part].excess > 0)) continue;
            const Vector D = direction_.col(i);
            sums_[part].along += D.dot(state.v.col(i).template cast<double>());
            sums_[part].square += D.squaredNorm() / static_cast<double>(system.mass(i));
        }
        return true;
    }

    using Vector = Eigen::Matrix<double, System::Dim, 1>;

    Points<double, System::Dim> direction_;  // D, N/s
    std::vector<Sum> sums_;                  // of each part
};

}  // namespace taut::guard_detail
