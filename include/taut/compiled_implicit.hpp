// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "compiled_laws.hpp"
#include "integrator/implicit_euler.hpp"
#include "solver/conjugate_gradient.hpp"
#include "solver/interleaved_llt.hpp"
#include "solver/sparse_cholesky.hpp"

// What the library Taut::Compiled holds of implicit steps: as compiled.hpp, for who includes
// integrator/implicit_euler.hpp.

#define TAUT_COMPILED_SOLVERS(KIND, SCALAR)  \
    KIND class InterleavedLLT<SCALAR>;       \
    TAUT_COMPILED_GRADIENTS(KIND, SCALAR, 1) \
    TAUT_COMPILED_GRADIENTS(KIND, SCALAR, 2) \
    TAUT_COMPILED_GRADIENTS(KIND, SCALAR, 3) \
    TAUT_COMPILED_LINEAR_SOLVE(KIND, SCALAR, SparseCholesky<SCALAR>)

#define TAUT_COMPILED_GRADIENTS(KIND, SCALAR, DIM) \
    KIND class TwoLevel<SCALAR, DIM>;              \
    KIND class ConjugateGradient<SCALAR, DIM>;     \
    TAUT_COMPILED_LINEAR_SOLVE(KIND, SCALAR, ConjugateGradient<SCALAR, DIM>)

#define TAUT_COMPILED_LINEAR_SOLVE(KIND, SCALAR, ...)                           \
    KIND class integrator_detail::FactorCache<__VA_ARGS__, SCALAR>;             \
    KIND class integrator_detail::LinearSolve<__VA_ARGS__, SCALAR>;             \
    KIND Report integrator_detail::LinearSolve<__VA_ARGS__, SCALAR>::solve(     \
        const integrator_detail::StepMatrix<SCALAR>&, VectorX<SCALAR>&, SCALAR, \
        integrator_detail::NothingHeld&&);

#define TAUT_COMPILED_TANGENT(KIND, SCALAR, DIM) \
    KIND class TangentMatrix<SCALAR, DIM>;       \
    KIND SparseMatrix<SCALAR> BlockPattern::zero<SCALAR, DIM>() const;

#define TAUT_COMPILED_IMPLICIT(KIND, ...) \
    TAUT_COMPILED_STEPPER(KIND, ImplicitEuler<SpringSystem<__VA_ARGS__>>)

#define TAUT_COMPILED_IMPLICIT_LAWS(KIND, SCALAR, DIM)     \
    TAUT_COMPILED_IMPLICIT(KIND, SCALAR, DIM)              \
    TAUT_COMPILED_IMPLICIT(KIND, SCALAR, DIM, TensionOnly) \
    TAUT_COMPILED_IMPLICIT(KIND, SCALAR, DIM, Hookean, Buckling)

// Of one scalar.
#define TAUT_COMPILED_SOLVERS_AND_TANGENTS(KIND, SCALAR) \
    TAUT_COMPILED_SOLVERS(KIND, SCALAR)                  \
    TAUT_COMPILED_TANGENT(KIND, SCALAR, 1)               \
    TAUT_COMPILED_TANGENT(KIND, SCALAR, 2)               \
    TAUT_COMPILED_TANGENT(KIND, SCALAR, 3)

#define TAUT_COMPILED_ALL_IMPLICIT(KIND, SCALAR)     \
    TAUT_COMPILED_SOLVERS_AND_TANGENTS(KIND, SCALAR) \
    TAUT_COMPILED_IMPLICIT(KIND, SCALAR, 1)          \
    TAUT_COMPILED_IMPLICIT_LAWS(KIND, SCALAR, 2)     \
    TAUT_COMPILED_IMPLICIT_LAWS(KIND, SCALAR, 3)

namespace taut {
#if defined(TAUT_COMPILED)
TAUT_COMPILED_ALL_IMPLICIT(extern template, float)
TAUT_COMPILED_ALL_IMPLICIT(extern template, double)
#endif
}  // namespace taut
