// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "../../core/buffer.hpp"
#include "../../core/types.hpp"

namespace taut::solver_detail {

/// Nonzeros of a Cholesky factor, the diagonal counted.
struct FactorSize {
    Index widest_row = 1;
    Index entries = 0;
};

/// That of the Cholesky factor of PAPᵀ, before it is computed: row k is what the nonzeros of column
/// k reach in the elimination tree (J. W. H. Liu, The role of elimination trees in sparse
/// factorization, 1990).
/// @param A      symmetric, both triangles stored
/// @param place  place(i): the row of PAPᵀ that row i of A becomes
/// @param most   counts no further than so many entries
template <class Place>
FactorSize factor_size(const SparseMatrix<double>& A, Place&& place,
                       Index most = (std::numeric_limits<Index>::max)()) {
    using Entry = SparseMatrix<double>::InnerIterator;
    const Index n = A.rows();
    Buffer<Index> column(n);  // of A, for each row of PAPᵀ
    for (Index i = 0; i < n; ++i) column[place(i)] = i;
    Buffer<Index> parent(n, -1);
    Buffer<Index> ancestor(n, -1);  // short cuts towards the root
    Buffer<Index> seen(n, -1);
    FactorSize size;
    for (Index k = 0; k < n && size.entries <= most; ++k) {
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
        size.widest_row = (std::max)(size.widest_row, count);
        size.entries += count;
    }
    return size;
}

}  // namespace taut::solver_detail
