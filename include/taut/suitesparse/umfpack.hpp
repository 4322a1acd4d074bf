// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/UmfPackSupport>
#include <type_traits>

#include "../core/types.hpp"

namespace taut {

/// UMFPACK's LU as a Solver for a GeneralLinearSystem; double only. Needs the CMake target
/// Taut::SuiteSparse. UMFPACK is GPL-2+: linking it puts your program under the GPL.
/// Where it is absent, Eigen::SparseLU<taut::SparseMatrix<Scalar>> serves the same steppers.
template <class Scalar = double>
class Umfpack : public Eigen::UmfPackLU<SparseMatrix<Scalar>> {
    static_assert(std::is_same_v<Scalar, double>, "taut::Umfpack: UMFPACK works in double only");
};

}  // namespace taut
