// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../pencil.hpp"

// Symplectic Euler, and velocity Verlet with it: 4M − 2hD − h²K ≻ 0.

namespace taut::stability_detail {

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

/// A limit on the graph Laplacians of a system. @param part  of it that is answered
template <class Scalar>
StepLimit<Scalar> of_laplacians(const Pencil& laplacian, std::uint64_t revision, double part = 1) {
    UnroundedLimit limit{0, infinity, Cause::overflow};
    if (laplacian.lost().empty()) limit = symplectic_by_bounds(laplacian);
    limit.certified *= part;
    return rounded<Scalar>(limit, revision);
}

}  // namespace taut::stability_detail

#if !defined(TAUT_COMPILED)
#include "symplectic_limit-inl.hpp"
#endif
