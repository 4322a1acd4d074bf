// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// TAUT_SAME_BITS, for a whole build: docs/engines.md.
#if defined(TAUT_SAME_BITS) && !defined(EIGEN_FAST_MATH)
#define EIGEN_FAST_MATH 0
#endif
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>

#if defined(TAUT_SAME_BITS) && (EIGEN_FAST_MATH || defined(__FAST_MATH__))
#error "TAUT_SAME_BITS needs -DEIGEN_FAST_MATH=0 where Eigen is included first, and no -ffast-math"
#endif
#if defined(TAUT_SAME_BITS) && defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ > 0
#error "TAUT_SAME_BITS needs numbers that are no wider than they are stored: -msse2 -mfpmath=sse"
#endif

namespace taut {

using Eigen::Index;

/// One column a particle: Dim × n, interleaved in memory as engines keep it (x y z x y z).
template <class Scalar, int Dim>
using Points = Eigen::Matrix<Scalar, Dim, Eigen::Dynamic>;

template <class Scalar>
using VectorX = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
template <class Scalar>
using MatrixX = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// Corners of a triangle, particle indices.
using Triangle = std::array<Index, 3>;

/// Compressed columns with 32-bit indices: what Eigen's and SuiteSparse's factorisations read.
template <class Scalar>
using SparseMatrix = Eigen::SparseMatrix<Scalar>;

/// The value that Scalar holds in place of `value`.
template <class Scalar>
double held_as(double value) {
    // GCC 12 at -O2 drops the two conversions where it makes them for two neighbours at once.
    const volatile Scalar held = static_cast<Scalar>(value);
    return static_cast<double>(held);
}

}  // namespace taut
