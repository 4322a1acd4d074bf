// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

// What units of the library tell each other that are compiled for different processors. They share
// no function and no type of Taut or Eigen: of an inline function compiled twice the linker keeps
// one for all, and might keep the one that the processor cannot run. So a wide unit
// (wide_kernels.cpp.in) has Taut and Eigen under names of its own. Here are pointers alone.

namespace taut_kernels {

inline constexpr int laws = 3;
inline constexpr int updates = 6;

/// The kernels of one set of instructions. Void is what has a name of its own in each unit, and the
/// same members.
template <class Scalar>
struct Table {
    /// LawPlan::add_forces<Both>.
    using Add = void (*)(const void* plan, const void* view);
    /// PlaceUpdate::move<Update>.
    using Move = void (*)(const void* update, const void* layout, const void* tile, Scalar h);

    /// Layout::to_planes and Layout::from_planes.
    using ToPlanes = void (*)(const void* layout, const Scalar* points, const void* planes,
                              const void* places);
    using FromPlanes = void (*)(const void* layout, const void* planes, Scalar* points,
                                const void* places);
    /// StateMemory::look_ahead.
    using LookAhead = void (*)(void* memory, Scalar ahead);
    /// detail::all_finite.
    using Finite = bool (*)(const Scalar* numbers, std::ptrdiff_t count);

    Add add[laws][3][2];  // law, dimension − 1, Both; null where there is none
    Move move[updates];
    ToPlanes to_planes[3];  // dimension − 1
    FromPlanes from_planes[3];
    LookAhead look_ahead;
    Finite finite;
    std::size_t sizes[4];  // of LawPlan, PlaceUpdate, Layout, StateMemory: the same in all units
};

}  // namespace taut_kernels
