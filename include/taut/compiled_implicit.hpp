// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "compiled_laws.hpp"
#include "integrator/implicit_euler.hpp"
#include "solver/conjugate_gradient.hpp"
#include "solver/interleaved_llt.hpp"

// What the library Taut::Compiled holds of implicit steps: as compiled.hpp, for who includes
// integrator/implicit_euler.hpp.

#define TAUT_COMPILED_SOLVERS(KIND, SCALAR)  \
    KIND class InterleavedLLT<SCALAR>;       \
    KIND class TwoLevel<SCALAR, 1>;          \
    KIND class TwoLevel<SCALAR, 2>;          \
    KIND class TwoLevel<SCALAR, 3>;          \
    KIND class ConjugateGradient<SCALAR, 1>; \
    KIND class ConjugateGradient<SCALAR, 2>; \
    KIND class ConjugateGradient<SCALAR, 3>;

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
