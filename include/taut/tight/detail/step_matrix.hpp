// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/LU>

#include "../../conditions/visit.hpp"

// step_matrix(descriptor, C, h, positions): the matrix whose eigenvalues are the multipliers of a
// whole system.
// C: [T1], n × n, 1/s: the rate of positions in its first `positions` rows, then that of
// velocities. h: s.

namespace taut::method {

template <class Matrix>
Matrix step_matrix(ExplicitEuler, const Matrix& C, typename Matrix::Scalar h, Eigen::Index) {
    return Matrix::Identity(C.rows(), C.cols()) + h * C;
}

/// v⁺ from the old x, then x⁺ from v⁺. Velocity Verlet's too.
template <class Matrix>
Matrix step_matrix(const SymplecticEuler&, const Matrix& C, typename Matrix::Scalar h,
                   Eigen::Index positions) {
    const Eigen::Index r = positions;
    const Eigen::Index N = C.rows() - r;
    Matrix step = Matrix::Identity(C.rows(), C.cols());
    step.bottomRows(N) += h * C.bottomRows(N);
    step.topRows(r) += h * C.block(0, r, r, r).diagonal().asDiagonal() * step.middleRows(r, r);
    return step;
}

/// v⁺ from x + hv where k > 0, from the old x elsewhere; then x⁺ from v⁺.
template <class Matrix>
Matrix step_matrix(EnergyStableEuler, const Matrix& C, typename Matrix::Scalar h,
                   Eigen::Index positions) {
    Matrix damped = C;
    for (Eigen::Index i = 0; i < positions; ++i) {
        const auto k = -C(i, positions + i) * C(positions + i, i);
        if (k > 0) damped(positions + i, positions + i) -= h * k;
    }
    return step_matrix(SymplecticEuler{}, damped, h, positions);
}

/// (I − hC)⁻¹.
template <class Matrix>
Matrix step_matrix(ImplicitEuler, const Matrix& C, typename Matrix::Scalar h, Eigen::Index) {
    const Matrix identity = Matrix::Identity(C.rows(), C.cols());
    return (identity - h * C).partialPivLu().inverse();
}

/// [[4S, −S], [I, 0]] with S = (3 − 2hC)⁻¹, on the state and the one before it: 2n × 2n.
template <class Matrix>
Matrix step_matrix(Bdf2, const Matrix& C, typename Matrix::Scalar h, Eigen::Index) {
    using Real = typename Matrix::Scalar;
    const Eigen::Index n = C.rows();
    const Matrix identity = Matrix::Identity(n, n);
    const Matrix solved = (3 * identity - 2 * h * C).partialPivLu().inverse();
    Matrix step = Matrix::Zero(2 * n, 2 * n);
    step.topLeftCorner(n, n) = Real(4) * solved;
    step.topRightCorner(n, n) = -solved;
    step.bottomLeftCorner(n, n) = identity;
    return step;
}

}  // namespace taut::method
