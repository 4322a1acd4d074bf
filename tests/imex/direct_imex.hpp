// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/scene_energy.hpp"

// The step of ImexEuler, its inertia and its condition, from the theory's formulas in long double,
// by dense matrices.

namespace taut_test {

/// n × n over all particles, pins included.
struct ImexMatrices {
    RealMatrix A;     ///< M + Σ s(h₀²k + ½h₀c)L_e, kg
    RealMatrix L, D;  ///< L_k, N/m, and what bounds the damping, N·s/m
    std::vector<Index> free;

    /// @param share  share(s) of spring s
    ImexMatrices(const Scene& scene, double step, const std::function<double(Index)>& share);

    RealMatrix free_part(const RealMatrix& of) const { return of(free, free); }
    /// Whether A ⪰ h²L_k + ½hD over the free particles.
    bool holds(Real h) const;
    /// The largest h of which it does, found between 0 and `most`.
    Real edge(Real most) const;
    /// ½vᵀ(A − M)v, J.
    Real added_energy(const Scene& scene, const AnyState& state) const;
};

/// The largest h for which an A that is made for h holds at h.
double edge_of_own(const Scene& scene, const std::function<double(Index)>& share);

/// h(f − D v + F) of the free particles in a step as the theory writes it, count × Dim, N·s.
RealMatrix impulses(const Scene& scene, const ImexMatrices& matrices, const StepAhead& ahead,
                    const AnyState& state, Real h, const RealMatrix& F);

/// Takes a step and keeps the books of H = ½vᵀAv + U, with the work of forces and pins by the
/// forces written out above.
Books book_imex(AnyStepper& stepper, const Scene& scene, const ImexMatrices& matrices,
                AnyState& state, double h, const RealMatrix& F);

}  // namespace taut_test
