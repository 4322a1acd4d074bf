// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../pencil.hpp"

// Symplectic Euler, and velocity Verlet with it: 4M − 2hD − h²K ≻ 0.

namespace taut::proof_detail {

/// The largest step of which 4M − 2hD − h²K⁺ ≻ 0 is proved by the bound [T19], [T23].
struct SymplecticStep {
    double h = 0;  ///< s
    double k = 0;  ///< the bound on k_max, 1/s²
};

SymplecticStep certified_symplectic(const Pencil& pencil);

/// The certified step by bounds alone; no vector is looked for that refutes.
UnroundedLimit symplectic_by_bounds(const Pencil& pencil);

/// What compression may add to the limit of a pencil of springs: admitted_growth, by its bound.
void add_compression(const Pencil& pencil, UnroundedLimit& limit);

/// A limit on the graph Laplacians of a system [T23]. @param part  of it that is answered
UnroundedLimit by_laplacian(const Pencil& laplacian, double part = 1);
template <class Scalar>
StepLimit<Scalar> of_laplacians(const Pencil& laplacian, std::uint64_t revision, double part = 1) {
    return rounded<Scalar>(by_laplacian(laplacian, part), revision);
}

/// What of the damping the proof of a method at any pose counts.
Pencil::Damping counted_at_any_pose(Method method);
/// The limit of a method at any pose. @param laplacian  with that part of the damping
UnroundedLimit at_any_pose(Method method, const Pencil& laplacian);

}  // namespace taut::proof_detail

#if !defined(TAUT_COMPILED)
#include "symplectic_limit-inl.hpp"
#endif
