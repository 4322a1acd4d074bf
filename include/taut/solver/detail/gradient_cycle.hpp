// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <cmath>

#include "../two_level.hpp"

namespace taut::solver_detail {

/// Conjugate gradients from 0, preconditioned by TwoLevel, in the arithmetic of one Scalar.
template <class Scalar, int Dim>
struct GradientCycle {
    using Matrix = BlockMatrix<Scalar, Dim>;

    TwoLevel<Scalar, Dim> preconditioner;
    VectorX<Scalar> x, r, z, p, q;  // solution, residual, P⁻¹r, direction, A p

    void analyze(const Matrix& A) {
        preconditioner.analyze(A);
        for (VectorX<Scalar>* v : {&x, &r, &z, &p, &q}) v->setZero(Dim * A.rows());
    }
    /// x ← an approximation of A⁻¹r; stops when the recurrence has ‖r‖ ≤ goal.
    /// @param iterations  so far, `cap` at most; counted on
    /// @returns NumericalIssue where pᵀAp ≤ 0 or not finite, NoConvergence at the cap
    Eigen::ComputationInfo run(const Matrix& A, Scalar goal, Index cap, Index& iterations) {
        x.setZero();
        p.setZero();
        Scalar rz = 1;
        while (!(r.norm() <= goal)) {  // a NaN goes on to the checks below
            preconditioner.apply(A, r, z);
            const Scalar next = r.dot(z);
            p = z + (next / rz) * p;
            rz = next;
            A.multiply(p, q);
            const Scalar curvature = p.dot(q);
            if (!(curvature > 0) || !detail::is_finite(curvature)) return Eigen::NumericalIssue;
            if (iterations == cap) return Eigen::NoConvergence;
            const Scalar step = rz / curvature;
            x += step * p;
            r -= step * q;
            ++iterations;
        }
        return Eigen::Success;
    }
};

}  // namespace taut::solver_detail
