// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "../core/buffer.hpp"
#include "../core/types.hpp"

namespace taut {

/// Two block columns, those of a spring's ends; −1 of a pinned one.
struct BlockPair {
    int a;
    int b;
};

/// The sparsity of a symmetric matrix of blocks: a block on the diagonal of every column and two
/// for every pair of columns that a spring joins.
class BlockPattern {
public:
    BlockPattern() = default;
    /// @param columns  n, block columns
    /// @param pairs    of every spring, they may repeat; one with a pinned end has no block
    BlockPattern(Index columns, const Buffer<BlockPair>& pairs) {
        Buffer<int> degree(columns, 1);
        for (const auto& [a, b] : pairs) {
            if (a < 0 || b < 0) continue;
            ++degree[a];
            ++degree[b];
        }
        Buffer<Index> end(degree.size());
        Index total = 0;
        for (std::size_t j = 0; j < degree.size(); ++j) {
            end[j] = total;
            total += degree[j];
        }
        rows_.resize(total);
        for (std::size_t j = 0; j < end.size(); ++j) rows_[end[j]++] = static_cast<int>(j);
        for (const auto& [a, b] : pairs) {
            if (a < 0 || b < 0) continue;
            rows_[end[a]++] = b;
            rows_[end[b]++] = a;
        }
        remove_repeats(degree);
    }

    /// n, block columns.
    Index columns() const { return static_cast<Index>(first_.size()) - 1; }
    /// Blocks of both triangles and the diagonal.
    Index blocks() const { return static_cast<Index>(rows_.size()); }
    /// The number of blocks before column j, 0 ≤ j ≤ n.
    Index first(Index j) const { return first_[j]; }
    /// Of the block (row, column) among those of its column, rows ascending.
    int place(Index row, Index column) const {
        const auto begin = rows_.begin() + first_[column];
        const auto end = rows_.begin() + first_[column + 1];
        return static_cast<int>(std::lower_bound(begin, end, static_cast<int>(row)) - begin);
    }
    /// The matrix of this pattern with Dim × Dim blocks, filled with zeros.
    template <class Scalar, int Dim>
    SparseMatrix<Scalar> zero() const {
        SparseMatrix<Scalar> A(Dim * columns(), Dim * columns());
        A.resizeNonZeros(Dim * Dim * blocks());
        Index next = 0;
        for (Index j = 0; j < columns(); ++j) {
            for (int c = 0; c < Dim; ++c) {
                A.outerIndexPtr()[Dim * j + c] = static_cast<int>(next);
                for (Index slot = first_[j]; slot < first_[j + 1]; ++slot) {
                    for (int r = 0; r < Dim; ++r) A.innerIndexPtr()[next++] = Dim * rows_[slot] + r;
                }
            }
        }
        A.outerIndexPtr()[A.cols()] = static_cast<int>(next);
        std::fill_n(A.valuePtr(), next, Scalar(0));
        return A;
    }
    /// Adds a block at its place in column j to the values of a matrix made by zero().
    template <class Scalar, int Dim>
    void add(SparseMatrix<Scalar>& A, int place, Index j,
             const Eigen::Matrix<Scalar, Dim, Dim>& block) const {
        const Index height = Dim * (first_[j + 1] - first_[j]);
        Scalar* corner = A.valuePtr() + Dim * Dim * first_[j] + Dim * place;
        for (int c = 0; c < Dim; ++c) {
            for (int r = 0; r < Dim; ++r) corner[c * height + r] += block(r, c);
        }
    }

private:
    void remove_repeats(const Buffer<int>& degree) {
        first_.assign(1, 0);
        auto kept = rows_.begin();
        auto begin = rows_.begin();
        for (const int size : degree) {
            std::sort(begin, begin + size);
            const auto end = std::unique(begin, begin + size);
            kept = std::copy(begin, end, kept);
            begin += size;
            first_.push_back(kept - rows_.begin());
        }
        rows_.resize(kept - rows_.begin());
    }

    Buffer<Index> first_ = Buffer<Index>(1, 0);  // block column → number of blocks before it
    Buffer<int> rows_;                           // block rows of all columns, ascending in each
};

}  // namespace taut
