// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "../../core/types.hpp"

namespace taut::solver_detail {

/// The most nonzeros in a row of the Cholesky factor of PAPᵀ, the diagonal counted, before it is
/// computed: row k is what the nonzeros of column k reach in the elimination tree (J. W. H. Liu,
/// The role of elimination trees in sparse factorization, 1990).
/// @param A      symmetric, both triangles stored
/// @param place  place(i): the row of PAPᵀ that row i of A becomes
template <class Place>
Index widest_factor_row(const SparseMatrix<double>& A, Place&& place) {
    using Entry = SparseMatrix<double>::InnerIterator;
    const auto n = static_cast<std::size_t>(A.rows());
    std::vector<Index> column(n);  // of A, for each row of PAPᵀ
    for (Index i = 0; i < A.rows(); ++i) column[place(i)] = i;
    std::vector<Index> parent(n, -1);
    std::vector<Index> ancestor(n, -1);  // short cuts towards the root
    std::vector<Index> seen(n, -1);
    Index widest = 1;
    for (Index k = 0; k < A.rows(); ++k) {
        for (Entry entry(A, column[k]); entry; ++entry) {
            for (Index i = place(entry.row()); i >= 0 && i < k;) {
                const Index next = ancestor[i];
                ancestor[i] = k;
                if (next < 0) parent[i] = k;
                i = next;
            }
        }
        Index count = 1;
        seen[k] = k;
        for (Entry entry(A, column[k]); entry; ++entry) {
            for (Index i = place(entry.row()); i < k && seen[i] != k; i = parent[i]) {
                seen[i] = k;
                ++count;
            }
        }
        widest = std::max(widest, count);
    }
    return widest;
}

}  // namespace taut::solver_detail
