// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <cstdlib>
#include <taut/scene/cloth.hpp>
#include <taut/equilibrium/equilibrium.hpp>

namespace bench {

/// A net of rows × columns that hangs from its upper edge, at equilibrium. It has no diagonals:
/// they would compress the rows, and its flat pose would buckle.
inline taut::SpringSystem<double, 3> hanging_net(taut::Index rows, taut::Index columns,
                                                 taut::State<double, 3>& state) {
    taut::ClothOptions options;
    options.rows = rows;
    options.columns = columns;
    options.pin_corners = false;
    options.diagonals = false;
    auto net = taut::hanging_cloth<double>(options);
    for (taut::Index c = 0; c < columns; ++c) net.pin(c);
    state = net.initial_state();
    state.x.row(2) = -state.x.row(1);
    state.x.row(1).setZero();
    if (!taut::static_equilibrium(net, state)) {
        std::fprintf(stderr, "hanging_net: no equilibrium was found\n");
        std::exit(1);
    }
    return net;
}

}  // namespace bench
