// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../error.hpp"
#include "../types.hpp"

namespace taut::detail {

/// Whether a State or StateView has as many positions and velocities.
template <class AnyState>
bool fits(const AnyState& state, Index particles) {
    return state.x.cols() == particles && state.v.cols() == particles;
}
/// Fails with a message that begins with `where` unless the state fits.
/// @param has  what says how many: "the system has"   @param of  what a column is one of
template <class AnyState>
void require_fits(const char* where, const AnyState& state, Index particles,
                  const char* has = "the system has", const char* of = "particles") {
    if (fits(state, particles)) return;
    fail(where, ": the state has ", state.x.cols(), " positions and ", state.v.cols(),
         " velocities; ", has, " ", particles, " ", of);
}

}  // namespace taut::detail
