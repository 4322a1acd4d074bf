// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

/// Rayleigh damping D = d0·M + α·K [T28]. Words, because textbooks swap the Greek letters.
struct RayleighDamping {
    double mass_proportional = 0;       ///< d0, 1/s
    double stiffness_proportional = 0;  ///< α, s
};

/// Damping in proportion to the springs' stiffness: D = projected·K⁺ + graph·(L_k ⊗ I).
template <class Scalar>
struct StiffnessDamping {
    Scalar projected = 0;  ///< α of K⁺ [T28], s: slows the change of length, spares rotation
    Scalar graph = 0;      ///< α of the graph Laplacian L_k [T34], s: slows all relative motion

    /// Whether there is any.
    explicit operator bool() const { return projected > 0 || graph > 0; }
    /// What bounds both together, for K⁺ ⪯ L_k ⊗ I at every pose.
    Scalar total() const { return projected + graph; }
    /// Both times `factor`.
    StiffnessDamping times(Scalar factor) const { return {factor * projected, factor * graph}; }
    /// The same in another precision.
    template <class Other>
    StiffnessDamping<Other> cast() const {
        return {static_cast<Other>(projected), static_cast<Other>(graph)};
    }
};

/// What an explicit stepper adds to a system's damping, as shares of its step h.
struct StepDamping {
    /// Springs pull as if their ends had moved on by this share of h·v: damping of α = look_ahead·h
    /// on K [T37], which spares rotation and costs nothing.
    double look_ahead = 0;
    double graph = 0;  ///< α/h of the graph Laplacian L_k [T34], which slows all relative motion

    /// Whether there is any.
    explicit operator bool() const { return look_ahead > 0 || graph > 0; }
    /// What bounds both together, as a share of h on L_k [T37].
    double total() const { return look_ahead + graph; }
    /// At steps of h: both in s.
    StepDamping times(double h) const { return {h * look_ahead, h * graph}; }
    /// As damping in proportion to K⁺: the same for small velocities, except in compressed springs.
    StiffnessDamping<double> linearized() const { return {look_ahead, graph}; }
};

}  // namespace taut
