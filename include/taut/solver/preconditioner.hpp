// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "detail/block_matrix.hpp"

namespace taut {

/// z = P⁻¹r with P the diagonal blocks of A: no dependence between particles, the cheapest.
template <class Scalar, int Dim>
class BlockJacobi {
public:
    using Matrix = solver_detail::BlockMatrix<Scalar, Dim>;

    /// Makes room for matrices of this size.
    void analyze(const Matrix& A) { inverse_.resize(static_cast<std::size_t>(A.rows())); }
    /// @returns whether every diagonal block is positive definite
    bool factorize(const Matrix& A) {
        for (Index i = 0; i < A.rows(); ++i) {
            const typename Matrix::Block block = A.block(A.diagonal(i));
            if (Eigen::LLT<typename Matrix::Block>(block).info() != Eigen::Success) return false;
            inverse_[i] = block.inverse();
        }
        return true;
    }
    /// z ← P⁻¹ r
    void apply(const Matrix& A, const VectorX<Scalar>& r, VectorX<Scalar>& z) const {
        for (Index i = 0; i < A.rows(); ++i) {
            z.template segment<Dim>(Dim * i).noalias() =
                inverse_[i] * r.template segment<Dim>(Dim * i);
        }
    }

private:
    std::vector<typename Matrix::Block> inverse_;  // of the diagonal blocks
};

/// z = P⁻¹r with P = (E + L)E⁻¹(E + Lᵀ): L is A below its diagonal blocks and E makes the diagonal
/// blocks of P those of A. Incomplete Cholesky without fill in which only the diagonal is
/// eliminated, so that it needs no storage beside A but E. Block by block after C. Pommerell,
/// "Solution of large unsymmetric systems of linear equations" (ETH Zürich, 1992).
template <class Scalar, int Dim>
class IncompleteCholesky {
public:
    using Matrix = solver_detail::BlockMatrix<Scalar, Dim>;
    using Block = typename Matrix::Block;

    /// Makes room for matrices of this size.
    void analyze(const Matrix& A) {
        inverse_.resize(static_cast<std::size_t>(A.rows()));
        y_.resize(Dim * A.rows());
    }
    /// A block of E that is not positive definite falls back on A's own.
    /// @returns whether every diagonal block of A is positive definite
    bool factorize(const Matrix& A) {
        for (Index i = 0; i < A.rows(); ++i) {
            const Block own = A.block(A.diagonal(i));
            Block E = own;
            for (int k = A.begin(i); k < A.diagonal(i); ++k) {
                const Block Lk = A.block(k);
                E.noalias() -= Lk * inverse_[A.column(k)] * Lk.transpose();
            }
            // What is left of a stiff block by cancellation would be a poor pivot.
            E -= Scalar(1e-3) * own;
            const bool usable = Eigen::LLT<Block>(E).info() == Eigen::Success;
            E = usable ? Block(E + Scalar(1e-3) * own) : own;
            if (!usable && Eigen::LLT<Block>(own).info() != Eigen::Success) return false;
            inverse_[i] = E.inverse();
        }
        return true;
    }
    /// z ← P⁻¹ r
    void apply(const Matrix& A, const VectorX<Scalar>& r, VectorX<Scalar>& z) {
        for (Index i = 0; i < A.rows(); ++i) {
            y_.template segment<Dim>(Dim * i).noalias() =
                inverse_[i] * (r.template segment<Dim>(Dim * i) -
                               A.product(A.begin(i), A.diagonal(i), y_.data()));
        }
        z = y_;
        for (Index i = A.rows() - 1; i >= 0; --i) {
            z.template segment<Dim>(Dim * i).noalias() -=
                inverse_[i] * A.product(A.diagonal(i) + 1, A.end(i), z.data());
        }
    }

private:
    std::vector<Block> inverse_;  // blocks of E⁻¹
    VectorX<Scalar> y_;           // Dim · rows
};

}  // namespace taut
