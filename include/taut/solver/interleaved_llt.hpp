// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>

#include "../core/buffer.hpp"
#include "../core/types.hpp"

namespace taut {

/// Sparse LLᵀ whose triangular solves take all columns of a narrow right-hand side at once: the
/// factor, far larger than the vectors, passes through memory twice instead of twice a column, and
/// up to four of its columns that share their rows go together.
///
/// Analysis and factorisation are Eigen's; solutions are those of Eigen's solves up to rounding.
template <class Scalar, class Ordering = Eigen::AMDOrdering<int>>
class InterleavedLLT : private Eigen::SimplicialLLT<SparseMatrix<Scalar>, Eigen::Lower, Ordering> {
    using Base = Eigen::SimplicialLLT<SparseMatrix<Scalar>, Eigen::Lower, Ordering>;

public:
    enum { UpLo = Eigen::Lower };
    /// n × Columns, its rows contiguous as Points keep them.
    template <int Columns>
    using Block = Eigen::Matrix<Scalar, Eigen::Dynamic, Columns,
                                Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

    using Base::analyzePattern;
    using Base::info;
    /// @param A  of the pattern analysed; indefinite: info() is not Eigen::Success
    void factorize(const SparseMatrix<Scalar>& A);

    /// The solution X of A X = B, for 1 to 4 columns. Kept until the next call.
    template <int Columns>
    Eigen::Map<const Block<Columns>> solve(const Block<Columns>& B) const;

private:
    // A row of the solution in a register of its own: three numbers travel in four.
    template <int Columns>
    using Lane = Eigen::Array<Scalar, Columns == 3 ? 4 : Columns, 1>;
    template <int Columns, int Width>
    void eliminate(int j) const;
    template <int Columns, int Width>
    void substitute(int j) const;

    const SparseMatrix<Scalar>& factor() const { return Base::matrixL().nestedExpression(); }
    template <int Columns>
    Eigen::Map<Lane<Columns>> lane(int row) const {
        return Eigen::Map<Lane<Columns>>(y_.data() + Lane<Columns>::RowsAtCompileTime * row);
    }

    Buffer<int> groups_;         // first columns of groups of 4, 2 or 1
    mutable VectorX<Scalar> y_;  // the permuted solution, in lanes
    mutable VectorX<Scalar> x_;  // the solution
};

template <class Scalar, class Ordering>
void InterleavedLLT<Scalar, Ordering>::factorize(const SparseMatrix<Scalar>& A) {
    Base::factorize(A);
    groups_.clear();
    if (info() != Eigen::Success) return;
    const int* first = factor().outerIndexPtr();
    const int* rows = factor().innerIndexPtr();
    const int n = static_cast<int>(factor().cols());
    // Column j + 1 has the rows of column j, without j, if there are as many and j + 1 comes next.
    const auto continues = [&](int j) {
        const int entries = first[j + 1] - first[j];
        return j + 1 < n && entries > 1 && rows[first[j] + 1] == j + 1 &&
               first[j + 2] - first[j + 1] == entries - 1;
    };
    for (int j = 0; j < n;) {
        groups_.push_back(j);
        int width = 1;
        while (width < 4 && continues(j + width - 1)) ++width;
        j += width == 3 ? 2 : width;
    }
    groups_.push_back(n);
}

/// y ← y − L y of columns j … j + Width − 1, after dividing by their diagonal.
template <class Scalar, class Ordering>
template <int Columns, int Width>
void InterleavedLLT<Scalar, Ordering>::eliminate(int j) const {
    const int* first = factor().outerIndexPtr() + j;
    const Scalar* values = factor().valuePtr();
    detail::Few<Lane<Columns>, Width> y;
    for (int a = 0; a < Width; ++a) {
        y[a] = lane<Columns>(j + a);
        for (int b = 0; b < a; ++b) y[a] -= values[first[b] + a - b] * y[b];
        y[a] /= values[first[a]];
        lane<Columns>(j + a) = y[a];
    }
    const int below = first[Width] - first[Width - 1] - 1;
    const int* rows = factor().innerIndexPtr() + first[Width] - below;
    detail::Few<const Scalar*, Width> column;
    for (int a = 0; a < Width; ++a) column[a] = values + first[a + 1] - below;
    for (int e = 0; e < below; ++e) {
        auto target = lane<Columns>(rows[e]);
        Lane<Columns> sum = target;
        for (int a = 0; a < Width; ++a) sum -= column[a][e] * y[a];
        target = sum;
    }
}

/// The same columns of Lᵀ, solved backwards.
template <class Scalar, class Ordering>
template <int Columns, int Width>
void InterleavedLLT<Scalar, Ordering>::substitute(int j) const {
    const int* first = factor().outerIndexPtr() + j;
    const Scalar* values = factor().valuePtr();
    detail::Few<Lane<Columns>, Width> y;
    for (int a = 0; a < Width; ++a) y[a] = lane<Columns>(j + a);
    const int below = first[Width] - first[Width - 1] - 1;
    const int* rows = factor().innerIndexPtr() + first[Width] - below;
    detail::Few<const Scalar*, Width> column;
    for (int a = 0; a < Width; ++a) column[a] = values + first[a + 1] - below;
    for (int e = 0; e < below; ++e) {
        const Lane<Columns> known = lane<Columns>(rows[e]);
        for (int a = 0; a < Width; ++a) y[a] -= column[a][e] * known;
    }
    for (int a = Width - 1; a >= 0; --a) {
        for (int b = a + 1; b < Width; ++b) y[a] -= values[first[a] + b - a] * y[b];
        y[a] /= values[first[a]];
        lane<Columns>(j + a) = y[a];
    }
}

template <class Scalar, class Ordering>
template <int Columns>
auto InterleavedLLT<Scalar, Ordering>::solve(const Block<Columns>& B) const
    -> Eigen::Map<const Block<Columns>> {
    static_assert(Columns >= 1 && Columns <= 4, "taut::InterleavedLLT: 1 to 4 columns");
    const auto n = static_cast<int>(B.rows());
    const auto& permutation = Base::permutationP().indices();
    const auto place = [&](int i) { return permutation.size() > 0 ? permutation[i] : i; };
    y_.setZero(Lane<Columns>::RowsAtCompileTime * n);
    for (int i = 0; i < n; ++i) {
        lane<Columns>(place(i)).template head<Columns>() = B.row(i).transpose().array();
    }
    for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
        switch (groups_[g + 1] - groups_[g]) {
            case 4: eliminate<Columns, 4>(groups_[g]); break;
            case 2: eliminate<Columns, 2>(groups_[g]); break;
            default: eliminate<Columns, 1>(groups_[g]);
        }
    }
    for (std::size_t g = groups_.size(); g-- > 1;) {
        switch (groups_[g] - groups_[g - 1]) {
            case 4: substitute<Columns, 4>(groups_[g - 1]); break;
            case 2: substitute<Columns, 2>(groups_[g - 1]); break;
            default: substitute<Columns, 1>(groups_[g - 1]);
        }
    }
    x_.resize(Columns * n);
    for (int i = 0; i < n; ++i) {
        x_.template segment<Columns>(Columns * i) =
            lane<Columns>(place(i)).template head<Columns>().matrix();
    }
    return {x_.data(), n, Columns};
}

}  // namespace taut
