// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "kernel_numbers.hpp"

// The kernels of this processor, for the library's own units: LawPlan::add_forces and
// PlaceUpdate::move ask here first where TAUT_KERNELS is defined.

namespace taut::step_detail {

/// The kernels to take; null: those of the library's own flags.
template <class Scalar>
const taut_kernels::Table<Scalar>* chosen_kernels();
template <>
const taut_kernels::Table<float>* chosen_kernels<float>();
template <>
const taut_kernels::Table<double>* chosen_kernels<double>();

/// LawPlan::add_forces<Both> by these. @returns whether there is one
template <class Scalar, int Dim, class Law, bool Both>
bool add_by_kernel(const LawPlan<Scalar, Dim, Law>& plan, const TileView<Scalar>& view,
                   std::bool_constant<Both>) {
    static_assert(law_number<Law> >= 0);
    const auto* table = chosen_kernels<Scalar>();
    const auto add = table ? table->add[law_number<Law>][Dim - 1][Both] : nullptr;
    if (add) add(&plan, &view);
    return add;
}

/// PlaceUpdate::move<Update> by these. @returns whether there is one
template <class Scalar, class Update>
bool move_by_kernel(const PlaceUpdate<Scalar>& update, const Layout<Scalar>& layout,
                    const TilePlaces<Scalar>& tile, Scalar h, Update) {
    static_assert(update_number<Update> >= 0);
    const auto* table = chosen_kernels<Scalar>();
    if (table) table->move[update_number<Update>](&update, &layout, &tile, h);
    return table;
}

}  // namespace taut::step_detail
