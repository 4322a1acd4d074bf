// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "integrator/energy_stable_euler.hpp"
#include "integrator/explicit_euler.hpp"
#include "integrator/symplectic_euler.hpp"
#include "integrator/velocity_verlet.hpp"
#include "scene/cloth.hpp"
#include "proof/any_pose.hpp"
#include "proof/energy_limit.hpp"
#include "proof/stability.hpp"

// What the library Taut::Compiled holds: explicit instantiations for float and double, two and
// three dimensions, springs by Hookean, by TensionOnly, and by Hookean with Buckling; Hookean
// springs in one dimension. Its users see them declared by taut.hpp, by a law's header and by those
// of implicit_euler and bracket; every module, other law, scalar or solver is compiled with the
// program as without it.
//
// KIND is `template` in the library's own sources, `extern template` elsewhere. A system's template
// arguments come last: its scalar, its dimension, its laws.
//
// Library and program must agree about Eigen's version and its alignment, which follows from flags
// like -mavx: a program that does not agree lacks a symbol named compiled_for. TAUT_USER_CONFIG and
// -fopenmp are those of the library. What steps do most exists for wider registers, too, and is
// chosen when a program runs: kernels.hpp.

#define TAUT_COMPILED_ANALYSIS(KIND, SCALAR)                    \
    KIND struct SpringSet<SCALAR, Hookean>;                     \
    KIND bool detail::all_finite<SCALAR>(const SCALAR*, Index); \
    KIND SpringSystem<SCALAR, 3> hanging_cloth<SCALAR>(const ClothOptions&);

// What all systems of a dimension share.
#define TAUT_COMPILED_SPACE(KIND, SCALAR, DIM)                                \
    KIND struct State<SCALAR, DIM>;                                           \
    KIND struct ExternalForces<SCALAR, DIM>;                                  \
    KIND class integrator_detail::StepLoop<State<SCALAR, DIM>>;               \
    KIND Report integrator_detail::StepLoop<State<SCALAR, DIM>>::check_state( \
        Index, const State<SCALAR, DIM>&, SCALAR);

// What the explicit steps of all laws share.
#define TAUT_COMPILED_SWEEP(KIND, SCALAR)                                 \
    TAUT_COMPILED_SPACE(KIND, SCALAR, 1)                                  \
    TAUT_COMPILED_SPACE(KIND, SCALAR, 2)                                  \
    TAUT_COMPILED_SPACE(KIND, SCALAR, 3)                                  \
    namespace step_detail {                                               \
    KIND class Layout<SCALAR>;                                            \
    KIND class StateMemory<SCALAR>;                                       \
    KIND class PlaceUpdate<SCALAR>;                                       \
    TAUT_COMPILED_SWEEP_BY(KIND, SCALAR, integrator_detail::KickAndDrift) \
    TAUT_COMPILED_SWEEP_BY(KIND, SCALAR, integrator_detail::DriftAndKick) \
    TAUT_COMPILED_SWEEP_BY(KIND, SCALAR, VerletUpdate<1, false>)          \
    TAUT_COMPILED_SWEEP_BY(KIND, SCALAR, VerletUpdate<2, false>)          \
    TAUT_COMPILED_SWEEP_BY(KIND, SCALAR, VerletUpdate<1, true>)           \
    TAUT_COMPILED_SWEEP_BY(KIND, SCALAR, VerletUpdate<0, true>)           \
    TAUT_COMPILED_SWEEP_IN(KIND, SCALAR, 1)                               \
    TAUT_COMPILED_SWEEP_IN(KIND, SCALAR, 2)                               \
    TAUT_COMPILED_SWEEP_IN(KIND, SCALAR, 3)                               \
    }

#define TAUT_COMPILED_SWEEP_BY(KIND, SCALAR, ...)                           \
    KIND void PlaceUpdate<SCALAR>::move<__VA_ARGS__>(const Layout<SCALAR>&, \
                                                     const TilePlaces<SCALAR>&, SCALAR) const;

#define TAUT_COMPILED_SWEEP_IN(KIND, SCALAR, DIM)                                                  \
    KIND void Layout<SCALAR>::to_planes(const Points<SCALAR, DIM>&, const Planes<SCALAR>&, Places) \
        const;                                                                                     \
    KIND void Layout<SCALAR>::from_planes(const Planes<SCALAR>&, Points<SCALAR, DIM>&, Places)     \
        const;                                                                                     \
    KIND void Steps<SCALAR, DIM>::load(const Surroundings<SCALAR, DIM>&, const Layout<SCALAR>&,    \
                                       bool, const State<SCALAR, DIM>&, SCALAR,                    \
                                       const ReadAnywhere&);                                       \
    KIND bool Steps<SCALAR, DIM>::run(const Forces&, State<SCALAR, DIM>&, SCALAR, Index, int,      \
                                      Move);                                                       \
    KIND bool Steps<SCALAR, DIM>::run_verlet(const Forces&, State<SCALAR, DIM>&, SCALAR, Index,    \
                                             int, bool);

// The explicit steps of one law's springs; a law that pushes has steps ahead of its own.
#define TAUT_COMPILED_LAW(KIND, SCALAR, DIM, LAW) \
    KIND class LawPlan<SCALAR, DIM, LAW>;         \
    KIND void LawPlan<SCALAR, DIM, LAW>::add_forces<false>(const TileView<SCALAR>&) const;

#define TAUT_COMPILED_PUSHING_LAW(KIND, SCALAR, DIM, LAW) \
    TAUT_COMPILED_LAW(KIND, SCALAR, DIM, LAW)             \
    KIND void LawPlan<SCALAR, DIM, LAW>::add_forces<true>(const TileView<SCALAR>&) const;

#define TAUT_COMPILED_LAWS(KIND, SCALAR)                \
    namespace step_detail {                             \
    TAUT_COMPILED_PUSHING_LAW(KIND, SCALAR, 1, Hookean) \
    TAUT_COMPILED_PUSHING_LAW(KIND, SCALAR, 2, Hookean) \
    TAUT_COMPILED_PUSHING_LAW(KIND, SCALAR, 3, Hookean) \
    }

#define TAUT_COMPILED_STEPPER(KIND, ...) \
    KIND class __VA_ARGS__;              \
    KIND Report __VA_ARGS__::step(State&, Scalar, Index);

#define TAUT_COMPILED_SYSTEM(KIND, SCALAR, DIM, ...)                                      \
    KIND void SpringSystem<__VA_ARGS__>::set_gravity(const Vector&);                      \
    KIND Index SpringSystem<__VA_ARGS__>::add_particle(const Vector&, SCALAR);            \
    KIND State<SCALAR, DIM> SpringSystem<__VA_ARGS__>::initial_state() const;             \
    KIND void SpringSystem<__VA_ARGS__>::force(const State&, Force&) const;               \
    KIND void SpringSystem<__VA_ARGS__>::force_ahead(const State&, SCALAR, Force&) const; \
    KIND SCALAR SpringSystem<__VA_ARGS__>::kinetic_energy(const State&) const;            \
    KIND SCALAR SpringSystem<__VA_ARGS__>::potential_energy(const State&) const;          \
    KIND Pencil Pencil::at_pose(const SpringSystem<__VA_ARGS__>&,                         \
                                const Points<TangentReal<SCALAR>, DIM>&);                 \
    KIND Pencil Pencil::any_pose(const SpringSystem<__VA_ARGS__>&, Pencil::Damping);      \
    KIND Stability<SCALAR>::Stability(const SpringSystem<__VA_ARGS__>&,                   \
                                      const State<SCALAR, DIM>&);                         \
    KIND StepLimit<SCALAR> any_pose_limit(const SpringSystem<__VA_ARGS__>&);              \
    KIND StepLimit<SCALAR> energy_limit(const SpringSystem<__VA_ARGS__>&);                \
    KIND class integrator_detail::ExplicitSteps<SpringSystem<__VA_ARGS__>>;               \
    TAUT_COMPILED_STEPPER(KIND, SymplecticEuler<SpringSystem<__VA_ARGS__>>)               \
    TAUT_COMPILED_STEPPER(KIND, ExplicitEuler<SpringSystem<__VA_ARGS__>>)                 \
    TAUT_COMPILED_STEPPER(KIND, VelocityVerlet<SpringSystem<__VA_ARGS__>>)                \
    TAUT_COMPILED_STEPPER(KIND, EnergyStableEuler<SpringSystem<__VA_ARGS__>>)

#define TAUT_COMPILED_EACH_SYSTEM(KIND, SCALAR)      \
    TAUT_COMPILED_SYSTEM(KIND, SCALAR, 1, SCALAR, 1) \
    TAUT_COMPILED_SYSTEM(KIND, SCALAR, 2, SCALAR, 2) \
    TAUT_COMPILED_SYSTEM(KIND, SCALAR, 3, SCALAR, 3)

namespace taut {
namespace detail {

/// Defined by the library for the alignment and the version of Eigen that it was compiled with.
template <int Bytes, int World, int Major>
bool compiled_for();

}  // namespace detail

#if defined(TAUT_COMPILED)
#if !defined(TAUT_COMPILED_SOURCE)
namespace {
// Kept by the compiler and, on ELF, by the linker, though nobody reads it. A call would be code
// that runs before main.
#if defined(__ELF__) && __has_cpp_attribute(gnu::retain)
[[gnu::used, gnu::retain]]
#elif defined(__GNUC__)
[[gnu::used]]
#else
[[maybe_unused]] const bool is_called =
    detail::compiled_for<EIGEN_MAX_ALIGN_BYTES, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION>();
[[maybe_unused]]
#endif
constexpr bool (*fits_library)() =
    &detail::compiled_for<EIGEN_MAX_ALIGN_BYTES, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION>;
}  // namespace
#endif
TAUT_COMPILED_SWEEP(extern template, float)
TAUT_COMPILED_SWEEP(extern template, double)
TAUT_COMPILED_LAWS(extern template, float)
TAUT_COMPILED_LAWS(extern template, double)
TAUT_COMPILED_ANALYSIS(extern template, float)
TAUT_COMPILED_ANALYSIS(extern template, double)
TAUT_COMPILED_EACH_SYSTEM(extern template, float)
TAUT_COMPILED_EACH_SYSTEM(extern template, double)
#endif

}  // namespace taut
