// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/error.hpp"
#include "../core/types.hpp"
#include "../method/graph_inertia.hpp"

namespace taut {

/// Of GraphInertia.
struct GraphInertiaOptions {
    /// For the springs, with OpenMP (-fopenmp) only. The same bits for any number.
    int threads = 1;
    /// θ, in (0, 1]: the share that is taken of the condition [T33]. At 1 cloths that move gain
    /// energy within minutes, and a guard's bound on the energy says nothing.
    double margin = method::GraphInertia::margin;
    /// δ, in [0, 1]: implicit damping of the springs that are implicit, which makes no step less
    /// stable. 0: none. 1: every spring is implicit, and the energy cannot rise at any step that
    /// the factor is made for, pins at rest [T35]; it slows all relative motion. The default keeps
    /// the energy of nearly all moving scenes tried at little error (docs/graph_inertia.md):
    /// measured, not proved.
    double dissipation = method::GraphInertia::dissipation;

    /// Fails for what is out of range.
    void require_valid() const {
        if (threads < 1) fail("GraphInertiaOptions: threads is ", threads, "; it must be >= 1");
        if (!(margin > 0 && margin <= 1))
            fail("GraphInertiaOptions: margin is ", margin, "; it must be in (0, 1]");
        if (!(dissipation >= 0 && dissipation <= 1))
            fail("GraphInertiaOptions: dissipation is ", dissipation, "; it must be in [0, 1]");
    }
};

}  // namespace taut
