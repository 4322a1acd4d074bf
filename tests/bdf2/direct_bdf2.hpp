// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/bdf2/bdf2.hpp>
#include <taut/solver/sparse_cholesky.hpp>

namespace taut_test {

/// BDF2 with a direct solver: exact to rounding.
template <class System>
struct DirectBdf2 : taut::Bdf2<System, taut::SparseCholesky<typename System::Scalar>> {
    explicit DirectBdf2(const System& system)
        : taut::Bdf2<System, taut::SparseCholesky<typename System::Scalar>>(system) {}
};

}  // namespace taut_test
