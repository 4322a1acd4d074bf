// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/model/spring_system.hpp>

namespace taut_test {

using taut::Index;

/// A cloth of rows × columns in its plane, unit masses and springs, two corners pinned; the springs
/// of the last row are `hem` times as stiff.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> hemmed_cloth(Index rows, Index columns, double hem) {
    taut::SpringSystem<Scalar, Dim> system;
    for (Index i = 0; i < rows * columns; ++i) {
        Eigen::Matrix<Scalar, Dim, 1> place = Eigen::Matrix<Scalar, Dim, 1>::Zero();
        place[0] = static_cast<Scalar>(i % columns);
        if (Dim > 1) place[Dim - 1] = static_cast<Scalar>(-(i / columns));
        system.add_particle(place, Scalar(1));
    }
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            const Index i = r * columns + c;
            const double k = r + 1 == rows ? hem : 1;
            const auto join = [&](Index j, double stiffness) {
                system.add_spring(taut::Spring<Scalar, taut::Hookean>{
                    i, j, {static_cast<Scalar>(stiffness)}, Scalar(1)});
            };
            if (c + 1 < columns) join(i + 1, k);
            if (r + 1 < rows) join(i + columns, 1);
        }
    }
    system.pin(0);
    system.pin(columns - 1);
    return system;
}

}  // namespace taut_test
