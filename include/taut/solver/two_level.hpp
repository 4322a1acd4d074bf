// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

#include "../core/buffer.hpp"
#include "block_ordering.hpp"
#include "detail/aggregates.hpp"
#include "detail/block_matrix.hpp"
#include "interleaved_llt.hpp"

namespace taut {

namespace solver_detail {

/// z = D⁻¹r with D the diagonal blocks of A.
template <class Scalar, int Dim>
class BlockJacobi {
public:
    using Matrix = BlockMatrix<Scalar, Dim>;

    /// Makes room for matrices of this size.
    void analyze(const Matrix& A) { inverse_.resize(static_cast<std::size_t>(A.rows())); }
    /// @returns whether every diagonal block is positive definite
    bool factorize(const Matrix& A) {
        for (Index i = 0; i < A.rows(); ++i) {
            const typename Matrix::Block block = A.block(A.diagonal(i));
            if (Eigen::LLT<typename Matrix::Block>(block).info() != Eigen::Success) return false;
            detail::at(inverse_, i) = block.inverse();
        }
        return true;
    }
    /// z ← P⁻¹ r
    void apply(const Matrix& A, const VectorX<Scalar>& r, VectorX<Scalar>& z) const {
        for (Index i = 0; i < A.rows(); ++i) {
            z.template segment<Dim>(Dim * i).noalias() =
                detail::at(inverse_, i) * r.template segment<Dim>(Dim * i);
        }
    }

private:
    std::vector<typename Matrix::Block> inverse_;  // of the diagonal blocks
};

}  // namespace solver_detail

/// z = D⁻¹r + Z (ZᵀAZ)⁻¹ Zᵀr: D is the diagonal blocks of A, and a column of Z moves one group of
/// some 25 neighbouring particles along one axis. Where springs tie distant particles together
/// within a step, slow modes cost most of the iterations. The small system ZᵀAZ, which sparse
/// Cholesky solves, takes them out.
///
/// The sum of both corrections is that of M. Dryja, O. B. Widlund, "Some domain decomposition
/// algorithms for elliptic problems" (1989); the columns of Z are those of R. A. Nicolaides,
/// "Deflation of conjugate gradients with applications to boundary value problems" (1987).
template <class Scalar, int Dim>
class TwoLevel {
public:
    using Matrix = solver_detail::BlockMatrix<Scalar, Dim>;

    /// Forms the groups and the pattern of ZᵀAZ.
    void analyze(const Matrix& A);
    /// @returns whether the diagonal blocks and ZᵀAZ are positive definite, as they are if A is
    bool factorize(const Matrix& A);
    /// z ← P⁻¹ r
    void apply(const Matrix& A, const VectorX<Scalar>& r, VectorX<Scalar>& z) {
        coarse_r_.setZero(coarse_.rows());
        for (Index i = 0; i < A.rows(); ++i) {
            coarse_r_.template segment<Dim>(Dim * groups_.of[i]) +=
                r.template segment<Dim>(Dim * i);
        }
        const auto coarse_z = llt_.template solve<1>(coarse_r_);
        jacobi_.apply(A, r, z);
        for (Index i = 0; i < A.rows(); ++i) {
            z.template segment<Dim>(Dim * i) +=
                coarse_z.template middleRows<Dim>(Dim * groups_.of[i]);
        }
    }

private:
    solver_detail::BlockJacobi<Scalar, Dim> jacobi_;
    solver_detail::Aggregates groups_;
    Buffer<int> targets_;          // block of A → where it adds to coarse_; −1: nowhere
    SparseMatrix<Scalar> coarse_;  // ZᵀAZ: both triangles for the ordering, values below only
    InterleavedLLT<Scalar, BlockOrdering<>> llt_;
    VectorX<Scalar> coarse_r_;  // Zᵀr
};

template <class Scalar, int Dim>
void TwoLevel<Scalar, Dim>::analyze(const Matrix& A) {
    jacobi_.analyze(A);
    // Half or twice the size costs about the same: what iterations gain, the factor loses.
    groups_.build(A, 25);
    std::vector<std::vector<int>> rows(static_cast<std::size_t>(groups_.count));
    for (Index i = 0; i < A.rows(); ++i) {
        for (int k = A.begin(i); k < A.end(i); ++k) {
            detail::at(rows, groups_.of[A.column(k)]).push_back(groups_.of[i]);
        }
    }
    coarse_.resize(Dim * groups_.count, Dim * groups_.count);
    for (int j = 0; j < coarse_.cols(); ++j) {
        std::vector<int>& blocks = detail::at(rows, j / Dim);
        if (j % Dim == 0) {
            std::sort(blocks.begin(), blocks.end());
            blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
        }
        coarse_.startVec(j);
        for (const int block : blocks) {
            for (int r = 0; r < Dim; ++r) coarse_.insertBack(Dim * block + r, j) = 0;
        }
    }
    coarse_.finalize();
    targets_.clear();
    for (Index i = 0; i < A.rows(); ++i) {
        const int row = groups_.of[i];
        for (int k = A.begin(i); k < A.end(i); ++k) {
            const int column = groups_.of[A.column(k)];
            const std::vector<int>& blocks = detail::at(rows, column);
            const auto place = std::lower_bound(blocks.begin(), blocks.end(), row);
            const auto before = static_cast<int>(place - blocks.begin());
            targets_.push_back(row < column ? -1
                                            : coarse_.outerIndexPtr()[Dim * column] + Dim * before);
        }
    }
    llt_.analyzePattern(coarse_);
}

template <class Scalar, int Dim>
bool TwoLevel<Scalar, Dim>::factorize(const Matrix& A) {
    if (!jacobi_.factorize(A)) return false;
    coarse_.coeffs().setZero();
    const int* outer = coarse_.outerIndexPtr();
    for (Index i = 0; i < A.rows(); ++i) {
        for (int k = A.begin(i); k < A.end(i); ++k) {
            if (targets_[k] < 0) continue;
            const int column = Dim * groups_.of[A.column(k)];
            const int stride = outer[column + 1] - outer[column];
            Scalar* target = coarse_.valuePtr() + targets_[k];
            const auto block = A.block(k);
            for (int c = 0; c < Dim; ++c) {
                for (int r = 0; r < Dim; ++r) target[stride * c + r] += block(r, c);
                // Stiffness cancels in the sums. Its rounding must not pass for a small mass.
                if (k == A.diagonal(i)) {
                    target[stride * c + c] +=
                        64 * std::numeric_limits<Scalar>::epsilon() * block(c, c);
                }
            }
        }
    }
    llt_.factorize(coarse_);
    return llt_.info() == Eigen::Success;
}

}  // namespace taut
