// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/integrator/detail/explicit_steps.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "kernel_table.hpp"

// Where a kernel is in a table. In a wide unit under that unit's names, like all of Taut.

namespace taut::step_detail {

template <class T, class... List>
constexpr int number_among() {
    int number = 0;
    const bool found = ((std::is_same_v<T, List> || (++number, false)) || ...);
    return found ? number : -1;
}
template <class Law>
inline constexpr int law_number = number_among<Law, Hookean, TensionOnly, Buckling>();
template <class Update>
inline constexpr int update_number = number_among<
    Update, integrator_detail::KickAndDrift, integrator_detail::DriftAndKick,
    VerletUpdate<1, false>, VerletUpdate<2, false>, VerletUpdate<1, true>, VerletUpdate<0, true>>();
/// The sizes of what a kernel gets by a pointer to void.
template <class Scalar>
constexpr void set_sizes(taut_kernels::Table<Scalar>& table) {
    table.sizes[0] = sizeof(LawPlan<Scalar, 3, Buckling>);
    table.sizes[1] = sizeof(PlaceUpdate<Scalar>);
    table.sizes[2] = sizeof(Layout<Scalar>);
}

}  // namespace taut::step_detail
