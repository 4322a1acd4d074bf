// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../core/types.hpp"

namespace taut::integrator_detail::sweep {

/// One vector a place, as Dim planes: plane d begins d·stride scalars after the first.
template <class Scalar>
struct Planes {
    Scalar* first = nullptr;
    Index stride = 0;
    Scalar* operator[](int d) const { return first + d * stride; }
    Planes at(Index place) const { return {first + place, stride}; }
};

/// visit(d) for each of the coordinates, unrolled whatever the compiler's flags.
template <int Dim, class Visitor>
EIGEN_ALWAYS_INLINE void for_each_axis(Visitor&& visit) {
    visit(0);
    if constexpr (Dim > 1) visit(1);
    if constexpr (Dim > 2) visit(2);
}

}  // namespace taut::integrator_detail::sweep
