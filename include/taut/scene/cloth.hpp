// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../network/spring_system.hpp"

namespace taut {

/// A rectangular cloth of rows × columns particles in the plane z = 0. Defaults: the reference
/// scene of the benchmarks.
struct ClothOptions {
    Index rows = 64;
    Index columns = 64;
    double height = 1;        ///< extent along y, m
    double width = 1;         ///< extent along x, m
    double mass = 0.3;        ///< of all particles together, kg, in equal parts
    double stretch = 1000;    ///< stiffness between neighbours and on both diagonals, N/m
    double bend = 100;        ///< stiffness between particles two apart, N/m; 0: none
    double gravity = 9.81;    ///< along −z, m/s²
    bool pin_corners = true;  ///< particles 0 and columns − 1, the corners of one edge
    bool diagonals = true;
    RayleighDamping rayleigh = {};  ///< none unless asked for
};

/// The cloth of `options`; particle row·columns + column.
/// @throws when rows or columns is < 2, or a physical value is out of its range
template <class Scalar>
SpringSystem<Scalar, 3> hanging_cloth(const ClothOptions& options = {}) {
    const Index rows = options.rows;
    const Index columns = options.columns;
    if (rows < 2 || columns < 2) {
        fail("hanging_cloth: ", rows, " rows and ", columns,
             " columns; at least 2 of each are needed");
    }
    require_non_negative("hanging_cloth", "stretch", options.stretch);
    require_non_negative("hanging_cloth", "bend", options.bend);
    require_non_negative("hanging_cloth", "height", options.height);
    require_non_negative("hanging_cloth", "width", options.width);
    require_positive("hanging_cloth", "mass", options.mass);
    SpringSystem<Scalar, 3> system;
    const auto count = static_cast<double>(rows * columns);
    const double dx = options.width / static_cast<double>(columns - 1);
    const double dy = options.height / static_cast<double>(rows - 1);
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            system.add_particle({static_cast<Scalar>(dx * static_cast<double>(c)),
                                 static_cast<Scalar>(dy * static_cast<double>(r)), Scalar(0)},
                                static_cast<Scalar>(options.mass / count));
        }
    }
    const auto join = [&](Index rise, Index run, double stiffness) {
        for (Index r = 0; r + rise < rows; ++r) {
            for (Index c = run < 0 ? -run : 0; c + run < columns && c < columns; ++c) {
                const Index a = r * columns + c;
                const Index b = a + rise * columns + run;
                system.add_spring(a, b, static_cast<Scalar>(stiffness));
            }
        }
    };
    join(0, 1, options.stretch);
    join(1, 0, options.stretch);
    if (options.diagonals) {
        join(1, 1, options.stretch);
        join(1, -1, options.stretch);
    }
    if (options.bend > 0) {
        join(0, 2, options.bend);
        join(2, 0, options.bend);
    }
    if (options.pin_corners) {
        system.pin(0);
        system.pin(columns - 1);
    }
    system.set_gravity({Scalar(0), Scalar(0), static_cast<Scalar>(-options.gravity)});
    system.set_rayleigh(options.rayleigh);
    return system;
}

/// The triangles of that cloth, two of each square, particle indices.
inline std::vector<Triangle> cloth_triangles(const ClothOptions& options = {}) {
    std::vector<Triangle> triangles;
    for (Index r = 0; r + 1 < options.rows; ++r) {
        for (Index c = 0; c + 1 < options.columns; ++c) {
            const Index a = r * options.columns + c;
            const Index d = a + options.columns;
            triangles.push_back({a, a + 1, d});
            triangles.push_back({a + 1, d + 1, d});
        }
    }
    return triangles;
}

}  // namespace taut
