// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <taut/taut.hpp>

#include "../hanging_net.hpp"
#include "run.hpp"

namespace bench::survival {

/// Energies, J, of symplectic Euler at whole seconds, and the largest kinetic energy on the way.
struct Motion {
    std::array<double, 6> energy{};
    double kinetic = 0;
};

inline Motion move(Net<3> net, Net<3>::State state, double share, const Damping& damping) {
    const double h = share * taut::any_pose_limit(net).certified;
    taut::SymplecticEuler<Net<3>> stepper(net, {1, damping.own()});
    Motion motion;
    motion.energy[0] = net.energy(state);
    for (std::size_t second = 1; second < motion.energy.size(); ++second) {
        constexpr int looks = 100;
        const auto steps = static_cast<Index>(std::ceil(1.0 / looks / h));
        for (int i = 0; i < looks; ++i) {
            if (!stepper.step(state, 1.0 / looks / static_cast<double>(steps), steps)) {
                std::fprintf(stderr, "survival_table: a step failed\n");
                std::exit(1);
            }
            motion.kinetic = std::max(motion.kinetic, net.kinetic_energy(state));
        }
        motion.energy[second] = net.energy(state);
    }
    return motion;
}

/// What the damping takes out of `start`, in shares of the largest kinetic energy of the undamped
/// motion at a twentieth of the limit.
inline void print_loss(const char* name, const Net<3>& net, const Net<3>::State& start) {
    const auto truth = move(net, start, 0.05, {});
    const auto line = [&](double share, const Damping& damping) {
        const auto motion = move(net, start, share, damping);
        std::printf("| %s | %g, %s |", name, share, damping.name().c_str());
        for (const std::size_t second : {1, 2, 5}) {
            std::printf(" %.3g |",
                        100 * (truth.energy[second] - motion.energy[second]) / truth.kinetic);
        }
        std::printf("\n");
    };
    line(0.05, {});
    line(0.5, {});
    for (const double ahead : {0.05, 0.1, 0.25, 0.4}) line(0.5, {DampingKind::look_ahead, ahead});
    line(0.5, {DampingKind::graph, 1});
}

/// Hookean cloths that nothing disturbs: one that falls, and one that swings about its rest.
inline void print_losses() {
    std::printf(
        "## What the damping takes\n\n"
        "Energy below that of the undamped motion at 0.05 of the limit, after 1, 2 and 5 s, in %% "
        "of that motion's largest kinetic energy. Symplectic Euler; h in shares of the any-pose "
        "limit. The swing is about the lowest one, of up to 0.1 m/s.\n\n"
        "| motion | h, damping | 1 s | 2 s | 5 s |\n|---|---|---|---|---|\n");
    const auto cloth = taut::hanging_cloth<double>({32, 32});
    print_loss("hanging_cloth 32 falls", cloth, cloth.initial_state());
    Net<3>::State rest;
    const auto net = bench::hanging_net(32, 32, rest);
    auto swing = rest;
    for (Index i = 0; i < net.size(); ++i) {
        swing.v(1, i) = net.is_pinned(i) ? 0 : 0.1 * -rest.x(2, i);
    }
    print_loss("net 32 swings", net, swing);
}

}  // namespace bench::survival
