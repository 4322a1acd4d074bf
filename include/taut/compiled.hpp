// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "integrator/energy_stable_euler.hpp"
#include "integrator/explicit_euler.hpp"
#include "integrator/implicit_euler.hpp"
#include "integrator/symplectic_euler.hpp"
#include "integrator/velocity_verlet.hpp"
#include "model/buckling.hpp"
#include "model/tension_only.hpp"
#include "scene/cloth.hpp"
#include "solver/conjugate_gradient.hpp"
#include "solver/interleaved_llt.hpp"
#include "stability/any_pose.hpp"
#include "stability/energy_limit.hpp"
#include "stability/stability.hpp"

// What the library Taut::Compiled holds: explicit instantiations for float and double, two and
// three dimensions, springs by Hookean, by TensionOnly, and by Hookean with Buckling; Hookean
// springs in one dimension. Its users see them declared by taut.hpp; every module, other law,
// scalar or solver is compiled with the program as without it.
//
// KIND is `template` in the library's own sources, `extern template` elsewhere. A system's template
// arguments come last: its scalar, its dimension, its laws.
//
// Library and program must agree about Eigen's version and its alignment, which follows from flags
// like -mavx: a program that does not agree lacks a symbol named compiled_for. TAUT_USER_CONFIG and
// -fopenmp are those of the library.

#define TAUT_COMPILED_ANALYSIS(KIND, SCALAR)                                 \
    KIND struct SpringSet<SCALAR, Hookean>;                                  \
    KIND struct SpringSet<SCALAR, TensionOnly>;                              \
    KIND struct SpringSet<SCALAR, Buckling>;                                 \
    KIND SpringSystem<SCALAR, 3> hanging_cloth<SCALAR>(const ClothOptions&); \
    KIND class Stability<SCALAR>;

#define TAUT_COMPILED_SOLVERS(KIND, SCALAR)  \
    KIND class InterleavedLLT<SCALAR>;       \
    KIND class TwoLevel<SCALAR, 1>;          \
    KIND class TwoLevel<SCALAR, 2>;          \
    KIND class TwoLevel<SCALAR, 3>;          \
    KIND class ConjugateGradient<SCALAR, 1>; \
    KIND class ConjugateGradient<SCALAR, 2>; \
    KIND class ConjugateGradient<SCALAR, 3>;

#define TAUT_COMPILED_PENCILS(KIND)                                            \
    KIND class SpringPencil<1>;                                                \
    KIND class SpringPencil<2>;                                                \
    KIND class SpringPencil<3>;                                                \
    KIND RitzPair largest_ritz_pair<double>(const Pencil&, const Combination&, \
                                            const LanczosOptions&, const Eigen::VectorXd&);

#define TAUT_COMPILED_STEPPER(KIND, ...) \
    KIND class __VA_ARGS__;              \
    KIND Report __VA_ARGS__::step(State&, Scalar, Index);

#define TAUT_COMPILED_SYSTEM(KIND, SCALAR, DIM, ...)                                            \
    KIND void SpringSystem<__VA_ARGS__>::set_gravity(const Vector&);                            \
    KIND Index SpringSystem<__VA_ARGS__>::add_particle(const Vector&, SCALAR);                  \
    KIND State<SCALAR, DIM> SpringSystem<__VA_ARGS__>::initial_state() const;                   \
    KIND void SpringSystem<__VA_ARGS__>::force(const State&, Force&) const;                     \
    KIND void SpringSystem<__VA_ARGS__>::force_ahead(const State&, SCALAR, Force&) const;       \
    KIND SCALAR SpringSystem<__VA_ARGS__>::kinetic_energy(const State&) const;                  \
    KIND SCALAR SpringSystem<__VA_ARGS__>::potential_energy(const State&) const;                \
    KIND SpringPencil<DIM> SpringPencil<DIM>::at_pose(const SpringSystem<__VA_ARGS__>&,         \
                                                      const Points<TangentReal<SCALAR>, DIM>&); \
    KIND SpringPencil<1> SpringPencil<1>::any_pose(const SpringSystem<__VA_ARGS__>&,            \
                                                   SpringPencil<1>::Damping);                   \
    KIND void Stability<SCALAR>::update(const SpringSystem<__VA_ARGS__>&,                       \
                                        const State<SCALAR, DIM>&);                             \
    KIND StepLimit<SCALAR> any_pose_limit(const SpringSystem<__VA_ARGS__>&);                    \
    KIND StepLimit<SCALAR> energy_limit(const SpringSystem<__VA_ARGS__>&);

#define TAUT_COMPILED_EXPLICIT(KIND, SCALAR, DIM, ...)                      \
    TAUT_COMPILED_STEPPER(KIND, SymplecticEuler<SpringSystem<__VA_ARGS__>>) \
    TAUT_COMPILED_STEPPER(KIND, ExplicitEuler<SpringSystem<__VA_ARGS__>>)   \
    TAUT_COMPILED_STEPPER(KIND, VelocityVerlet<SpringSystem<__VA_ARGS__>>)  \
    TAUT_COMPILED_STEPPER(KIND, EnergyStableEuler<SpringSystem<__VA_ARGS__>>)

#define TAUT_COMPILED_IMPLICIT(KIND, SCALAR, DIM, ...) \
    TAUT_COMPILED_STEPPER(KIND, ImplicitEuler<SpringSystem<__VA_ARGS__>>)

#define TAUT_COMPILED_EACH_LAW(PART, KIND, SCALAR, DIM) \
    PART(KIND, SCALAR, DIM, SCALAR, DIM)                \
    PART(KIND, SCALAR, DIM, SCALAR, DIM, TensionOnly)   \
    PART(KIND, SCALAR, DIM, SCALAR, DIM, Hookean, Buckling)

#define TAUT_COMPILED_EACH_SYSTEM(PART, KIND)     \
    PART(KIND, float, 1, float, 1)                \
    PART(KIND, double, 1, double, 1)              \
    TAUT_COMPILED_EACH_LAW(PART, KIND, float, 2)  \
    TAUT_COMPILED_EACH_LAW(PART, KIND, float, 3)  \
    TAUT_COMPILED_EACH_LAW(PART, KIND, double, 2) \
    TAUT_COMPILED_EACH_LAW(PART, KIND, double, 3)

namespace taut {
namespace detail {

/// Defined by the library for the alignment and the version of Eigen that it was compiled with.
template <int Bytes, int World, int Major>
bool compiled_for();

}  // namespace detail

#if defined(TAUT_COMPILED)
#if !defined(TAUT_COMPILED_SOURCE)
namespace {
[[maybe_unused]] const bool fits_library =
    detail::compiled_for<EIGEN_MAX_ALIGN_BYTES, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION>();
}  // namespace
#endif
TAUT_COMPILED_PENCILS(extern template)
TAUT_COMPILED_SOLVERS(extern template, float)
TAUT_COMPILED_SOLVERS(extern template, double)
TAUT_COMPILED_ANALYSIS(extern template, float)
TAUT_COMPILED_ANALYSIS(extern template, double)
TAUT_COMPILED_EACH_SYSTEM(TAUT_COMPILED_SYSTEM, extern template)
TAUT_COMPILED_EACH_SYSTEM(TAUT_COMPILED_EXPLICIT, extern template)
TAUT_COMPILED_EACH_SYSTEM(TAUT_COMPILED_IMPLICIT, extern template)
#endif

}  // namespace taut
