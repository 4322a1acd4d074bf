// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/CholmodSupport>
#include <type_traits>

#include "../core/types.hpp"

namespace taut {

/// CHOLMOD's supernodal LLᵀ as a Solver for the symmetric step; double only. Needs the CMake target
/// Taut::SuiteSparse. The supernodal module is GPL-2+: linking it puts your program under the GPL.
template <class Scalar = double>
class Cholmod : public Eigen::CholmodSupernodalLLT<SparseMatrix<Scalar>> {
    static_assert(std::is_same_v<Scalar, double>, "taut::Cholmod: CHOLMOD works in double only");

public:
    Cholmod() { this->cholmod().print = 0; }  // a failure is reported by info(), not on the console
};

}  // namespace taut
