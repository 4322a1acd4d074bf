// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/constraints/constraints.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/solver/sparse_cholesky.hpp>

// What steps that hold particles share, compiled once for the tests.

#define TAUT_TEST_HELD(KIND, SCALAR, DIM)                                              \
    KIND class ParticleConstraints<SCALAR, DIM>;                                       \
    KIND class integrator_detail::HeldParticles<SCALAR, DIM>;                          \
    KIND Report integrator_detail::LinearSolve<SparseCholesky<SCALAR>, SCALAR>::solve( \
        const integrator_detail::StepMatrix<SCALAR>&, VectorX<SCALAR>&, SCALAR,        \
        integrator_detail::HeldParticles<SCALAR, DIM>&);

#define TAUT_TEST_ALL_HELD(KIND)    \
    TAUT_TEST_HELD(KIND, float, 1)  \
    TAUT_TEST_HELD(KIND, float, 2)  \
    TAUT_TEST_HELD(KIND, float, 3)  \
    TAUT_TEST_HELD(KIND, double, 1) \
    TAUT_TEST_HELD(KIND, double, 2) \
    TAUT_TEST_HELD(KIND, double, 3)

namespace taut {
TAUT_TEST_ALL_HELD(extern template)
}  // namespace taut
