// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>

#include "block_ordering.hpp"

namespace taut {

/// Eigen's sparse LLᵀ in an order of particles: a direct Solver, exact to rounding. It is faster
/// than ConjugateGradient where one factor serves many steps and on chains in one dimension.
template <class Scalar>
using SparseCholesky = Eigen::SimplicialLLT<SparseMatrix<Scalar>, Eigen::Lower, BlockOrdering<>>;

}  // namespace taut
