// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/core/types.hpp>

#include "../support/random.hpp"

namespace taut_test {

/// M + h²K⁺ of a random scene in a crumpled pose, a matrix of dim × dim blocks.
taut::SparseMatrix<double> random_step_matrix(Random& random, int dim, Index particles,
                                              Index springs, double h);

}  // namespace taut_test
