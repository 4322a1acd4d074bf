// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>

// Seeds for which something was false once: every search of more than one seed judges them first.
// They name scenes only as long as random_scene.hpp draws as it does.

namespace soundness {

inline constexpr std::initializer_list<std::uint32_t> once_false_springs = {
    // Poses at a kink of TensionOnly or Buckling.
    1, 2, 5, 10, 14, 27, 28, 100011,
    // Windows of explicit Euler whose ends were not rounded inwards.
    1057, 1300, 1475, 1840,
    // Refuted by an enclosure on both sides of critical damping, or of 0.
    1934, 2511, 10314,
    // Explicit Euler near critical damping, where springs are compressed by their rounding.
    511654,
    // The ends of double and of float.
    1113, 1229, 1262, 1377, 1394, 1437, 1465, 1581, 1652, 1693, 1719, 1743, 1798, 1886, 1932,
    100008, 100247, 100358, 100527, 100687, 100727, 101057, 101141, 310400, 403600,
    // Rayleigh factors that float does not hold.
    303365, 306385, 309423, 311625,
    // Windows of explicit Euler at a kink, with d0 close to 2/h.
    200266, 200569,
    // Two equal slow growths of buckled modes that rounded to a complex pair.
    552002,
    // What D - hK lacks, lost where springs are compressed by rounding; the end of Buckling's arc
    // between the ends of what rounding reaches.
    661062, 671868};
inline constexpr std::initializer_list<std::uint32_t> once_false_linear = {
    // Windows.
    1001, 1097, 1168, 1256, 1324, 1404,
    // Implicit Euler with a D that is semi-definite but for rounding.
    1611, 1636, 11108,
    // Explicit Euler where K and D are negative; an endless bisection.
    70478, 81893, 11455, 423438,
    // The ends of double.
    1751, 1752, 1769, 10665, 80650, 80894, 100260, 100677, 100901, 101362};

}  // namespace soundness
