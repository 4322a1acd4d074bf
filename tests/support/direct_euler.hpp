// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/integrator/implicit_euler.hpp>
#include <taut/solver/sparse_cholesky.hpp>

namespace taut_test {

/// Implicit Euler with a direct solver: exact to rounding.
template <class System>
struct DirectEuler : taut::ImplicitEuler<System, taut::SparseCholesky<typename System::Scalar>> {
    explicit DirectEuler(const System& system)
        : taut::ImplicitEuler<System, taut::SparseCholesky<typename System::Scalar>>(system) {}
};

}  // namespace taut_test
