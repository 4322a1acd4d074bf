// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/guard/guard.hpp>
#include <taut/network/tension_only.hpp>
#include <utility>

// A crowd in capes: many small cloths, each with a guard of its own.

namespace bench {

using Cape = taut::SpringSystem<float, 3, taut::TensionOnly, taut::Hookean>;

/// 0.6 m × 0.9 m, 0.4 kg, by its upper corners, particles 0 and 15.
inline Cape cape() {
    using taut::Index;
    constexpr int rows = 20, columns = 16;
    Cape cape;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            cape.add_particle({0.6f * float(c) / (columns - 1), 0, -0.9f * float(r) / (rows - 1)},
                              0.4f / (rows * columns));
        }
    }
    const auto join = [&](int r, int c, int down, int across) {
        const int s = r + down, d = c + across;
        if (s >= rows || d < 0 || d >= columns) return;
        const Index a = r * columns + c, b = s * columns + d;
        if (down == 2 || across == 2) {
            cape.add_spring<taut::Hookean>(a, b, {5.0f}, 0.0f);
        } else {
            cape.add_spring<taut::TensionOnly>(a, b, {500.0f}, 0.0f);
        }
    };
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            for (const auto& [down, across] :
                 {std::pair{0, 1}, {1, 0}, {1, 1}, {1, -1}, {0, 2}, {2, 0}}) {
                join(r, c, down, across);
            }
        }
    }
    cape.pin(0);
    cape.pin(columns - 1);
    cape.set_gravity({0, 0, -9.81f});
    return cape;
}

struct Wearer {
    Cape cape = bench::cape();
    Cape::State state = cape.initial_state();
    taut::Guarded<taut::VelocityVerlet<Cape>> guard{cape};

    /// A frame of 1/60 s: the upper corners sway.
    /// @param frame  which   @param phase  of this one
    taut::GuardedReport<float> advance(int frame, float phase) {
        const float speed = 1.5f * std::cos(6.28f * float(frame) / 60 + phase);
        for (const taut::Index corner : {0, 15})
            state.v.col(corner) = Eigen::Vector3f(speed, 0.3f * speed, 0);
        return guard.advance(state, 1.0f / 60);
    }
};

}  // namespace bench
