// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "../../core/buffer.hpp"
#include "block_matrix.hpp"

namespace taut::solver_detail {

/// The block rows of a matrix in connected groups of about `size`, neighbours in its graph with
/// neighbours.
struct Aggregates {
    Buffer<int> of;  // block row → its group
    int count = 0;   // of groups

    template <class Scalar, int Dim>
    void build(const BlockMatrix<Scalar, Dim>& A, std::size_t size);
};

/// Grows one group after the other, breadth first, from the first row that has none. What remains
/// between grown groups joins one of them.
template <class Scalar, int Dim>
void Aggregates::build(const BlockMatrix<Scalar, Dim>& A, std::size_t size) {
    of.assign(A.rows(), -1);
    count = 0;
    std::vector<int> group;
    for (int seed = 0; seed < A.rows(); ++seed) {
        if (of[seed] >= 0) continue;
        of[seed] = count;
        group.assign(1, seed);
        int neighbour = -1;
        for (std::size_t next = 0; next < group.size(); ++next) {
            const int row = group[next];
            for (int k = A.begin(row); k < A.end(row); ++k) {
                const int column = A.column(k);
                if (of[column] < 0 && group.size() < size) {
                    of[column] = count;
                    group.push_back(column);
                } else if (of[column] >= 0 && of[column] < count) {
                    neighbour = of[column];
                }
            }
        }
        if (neighbour < 0 || 3 * group.size() >= size) {
            ++count;
            continue;
        }
        for (const int row : group) of[row] = neighbour;
    }
}

}  // namespace taut::solver_detail
