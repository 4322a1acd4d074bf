// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "../../core/buffer.hpp"
#include "../../core/error.hpp"
#include "../../core/types.hpp"

namespace taut::solver_detail {

/// A symmetric matrix of full Dim × Dim blocks by rows of blocks: one index a block instead of one
/// an entry, and products that run in vector registers without gathers.
template <class Scalar, int Dim>
class BlockMatrix {
public:
    using Block = Eigen::Matrix<Scalar, Dim, Dim>;
    using Segment = Eigen::Matrix<Scalar, Dim, 1>;

    /// Reads the pattern of A. Fails unless it consists of full Dim × Dim blocks.
    void set_pattern(const SparseMatrix<Scalar>& A);
    /// Reads the values of A, whose pattern is known.
    void set_values(const SparseMatrix<Scalar>& A);

    /// Takes the pattern of `other`.
    template <class Other>
    void copy_pattern(const BlockMatrix<Other, Dim>& other) {
        first_ = other.first_;
        columns_ = other.columns_;
        diagonal_ = other.diagonal_;
        values_.assign(other.values_.size(), Scalar(0));
    }
    /// Takes factor · the values of `other`, which has the same pattern, rounded.
    template <class Other>
    void copy_values(const BlockMatrix<Other, Dim>& other, Other factor) {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            values_[i] = static_cast<Scalar>(factor * other.values_[i]);
        }
    }
    /// The largest entry on the diagonal, in a positive definite matrix the largest of all.
    Scalar largest_diagonal() const {
        Scalar largest = 0;
        for (Index i = 0; i < rows(); ++i) {
            largest = (std::max)(largest, block(diagonal(i)).diagonal().maxCoeff());
        }
        return largest;
    }

    /// The number of block rows.
    Index rows() const { return static_cast<Index>(diagonal_.size()); }
    int begin(Index row) const { return first_[row]; }
    int diagonal(Index row) const { return diagonal_[row]; }
    int end(Index row) const { return first_[row + 1]; }
    /// Block columns ascend within a row.
    int column(int block) const { return columns_[block]; }
    Eigen::Map<const Block> block(int block) const {
        return Eigen::Map<const Block>(values_.data() + Dim * Dim * block);
    }

    /// Σ of block·x[column] over the blocks from `begin` to `end`: a row's product, or a part of
    /// it.
    /// @param x  Dim · rows() scalars
    Segment product(int begin, int end, const Scalar* x) const {
        detail::Few<Lane, Dim> sum;  // several, since each addition to a sum waits for the last
        sum.fill(Lane::Zero());
        for (int k = begin; k < end; ++k) {
            const Scalar* a = values_.data() + Dim * Dim * k;
            const Scalar* xk = x + Dim * columns_[k];
            for (int c = 0; c < Dim; ++c) sum[c] += Eigen::Map<const Lane>(a + Dim * c) * xk[c];
        }
        for (int c = 1; c < Dim; ++c) sum[0] += sum[c];
        return sum[0].template head<Dim>().matrix();
    }
    /// y ← A x.
    void multiply(const VectorX<Scalar>& x, VectorX<Scalar>& y) const {
        for (Index i = 0; i < rows(); ++i) {
            y.template segment<Dim>(Dim * i) = product(begin(i), end(i), x.data());
        }
    }

private:
    template <class, int>
    friend class BlockMatrix;
    // Three numbers travel in a register of four; what the fourth reads is never used.
    using Lane = Eigen::Array<Scalar, Dim == 3 ? 4 : Dim, 1>;

    Buffer<int> first_;           // block row → its first block
    Buffer<int> columns_;         // block → block column
    Buffer<int> diagonal_;        // block row → its diagonal block
    std::vector<Scalar> values_;  // Dim × Dim by columns for each block, and one more
};

template <class Scalar, int Dim>
void BlockMatrix<Scalar, Dim>::set_pattern(const SparseMatrix<Scalar>& A) {
    const auto refuse = [](Index column) {
        fail("ConjugateGradient: column ", column, " of the matrix has no full ", Dim, " by ", Dim,
             " blocks, or none on the diagonal; name Dim = 1 for a matrix without blocks");
    };
    if (A.rows() != A.cols() || A.rows() % Dim != 0 || !A.isCompressed()) refuse(0);
    first_.assign(1, 0);
    columns_.clear();
    diagonal_.clear();
    const int* rows = A.innerIndexPtr();
    for (Index j = 0; j < A.cols() / Dim; ++j) {
        const int* outer = A.outerIndexPtr() + Dim * j;
        const int entries = outer[1] - outer[0];
        for (int c = 0; c < Dim; ++c) {
            if (outer[c + 1] - outer[c] != entries || entries % Dim != 0) refuse(Dim * j + c);
            for (int e = 0; e < entries; ++e) {
                const int row = rows[outer[0] + e];
                const bool in_block =
                    e % Dim == 0 ? row % Dim == 0 : row == rows[outer[0] + e - 1] + 1;
                if (!in_block || rows[outer[c] + e] != row) refuse(Dim * j + c);
            }
        }
        int diagonal = -1;
        for (int e = 0; e < entries; e += Dim) {
            const int row = rows[outer[0] + e] / Dim;
            if (row == j) diagonal = static_cast<int>(columns_.size());
            columns_.push_back(row);
        }
        if (diagonal < 0) refuse(Dim * j);
        diagonal_.push_back(diagonal);
        first_.push_back(static_cast<int>(columns_.size()));
    }
    values_.assign(Dim * Dim * (columns_.size() + 1), Scalar(0));
}

template <class Scalar, int Dim>
void BlockMatrix<Scalar, Dim>::set_values(const SparseMatrix<Scalar>& A) {
    TAUT_ASSERT(A.nonZeros() == Dim * Dim * static_cast<Index>(columns_.size()),
                "the matrix must have the pattern that was analysed");
    Scalar* target = values_.data();
    for (Index j = 0; j < rows(); ++j) {
        const Scalar* source = A.valuePtr() + Dim * Dim * first_[j];
        const int stride = Dim * (end(j) - begin(j));  // from column to column
        for (int k = begin(j); k < end(j); ++k, source += Dim, target += Dim * Dim) {
            // A column of A is a row of A.
            for (int r = 0; r < Dim; ++r) {
                for (int c = 0; c < Dim; ++c) target[Dim * c + r] = source[stride * r + c];
            }
        }
    }
}

}  // namespace taut::solver_detail
