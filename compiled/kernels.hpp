// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "kernel_numbers.hpp"

// The kernels of this processor, for the library's own units: by_kernel.hpp.

namespace taut::detail {

/// The kernels to take; all null: those of the library's own flags.
const taut_kernels::Table<float>& chosen_kernels(float);
const taut_kernels::Table<double>& chosen_kernels(double);

/// Each function gives a kernel, or null for the library's own.
template <class Scalar>
struct Kernels {
    using Table = taut_kernels::Table<Scalar>;

    template <bool Both, int Dim, class Law>
    static typename Table::Add add(const step_detail::LawPlan<Scalar, Dim, Law>&) {
        constexpr int law = step_detail::law_number<Law>;
        static_assert(law >= 0, "compiled/kernel_numbers.hpp does not know this law");
        return chosen_kernels(Scalar()).add[law][Dim - 1][Both];
    }
    template <class Update>
    static typename Table::Move move(Update) {
        constexpr int update = step_detail::update_number<Update>;
        static_assert(update >= 0, "compiled/kernel_numbers.hpp does not know this update");
        return chosen_kernels(Scalar()).move[update];
    }
    template <int Dim>
    static typename Table::ToPlanes to_planes(const Points<Scalar, Dim>&) {
        return chosen_kernels(Scalar()).to_planes[Dim - 1];
    }
    template <int Dim>
    static typename Table::FromPlanes from_planes(const Points<Scalar, Dim>&) {
        return chosen_kernels(Scalar()).from_planes[Dim - 1];
    }
    /// Points of other kinds have none.
    template <class Matrix>
    static void (*to_planes(const Matrix&))(...) {
        return nullptr;
    }
    template <class Matrix>
    static void (*from_planes(const Matrix&))(...) {
        return nullptr;
    }
    static typename Table::LookAhead look_ahead() { return chosen_kernels(Scalar()).look_ahead; }
    static typename Table::Finite finite() { return chosen_kernels(Scalar()).finite; }
};

}  // namespace taut::detail
