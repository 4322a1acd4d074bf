// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/OrderingMethods>
#include <algorithm>

#include "../core/buffer.hpp"
#include "../core/types.hpp"

namespace taut {
namespace solver_detail {

/// A symmetric pattern with each run of consecutive columns of the same rows drawn together to one
/// vertex: for the Dim × Dim blocks of springs, the graph of the particles.
struct CompressedGraph {
    Buffer<int> first;            // vertex → its first column; at the end the number of columns
    SparseMatrix<double> matrix;  // full symmetric pattern between vertices, ones

    /// @param A  compressed, both triangles, rows ascending
    template <class Scalar>
    explicit CompressedGraph(const SparseMatrix<Scalar>& A);

    Index vertices() const { return static_cast<Index>(first.size()) - 1; }
    /// The columns in the order of `vertex`, which lists all vertices.
    template <class Permutation>
    void expand(const int* vertex, Permutation& columns) const {
        int next = 0;
        for (Index k = 0; k < vertices(); ++k) {
            for (int c = first[vertex[k]]; c < first[vertex[k] + 1]; ++c) columns[next++] = c;
        }
    }
};

template <class Scalar>
CompressedGraph::CompressedGraph(const SparseMatrix<Scalar>& A) {
    const int* outer = A.outerIndexPtr();
    const int* rows = A.innerIndexPtr();
    Buffer<int> vertex(A.cols());
    for (int j = 0; j < A.cols(); ++j) {
        const bool same = j > 0 && outer[j + 1] - outer[j] == outer[j] - outer[j - 1] &&
                          std::equal(rows + outer[j], rows + outer[j + 1], rows + outer[j - 1]);
        if (!same) first.push_back(j);
        vertex[j] = static_cast<int>(first.size()) - 1;
    }
    first.push_back(static_cast<int>(A.cols()));
    matrix.resize(vertices(), vertices());
    for (Index v = 0; v < vertices(); ++v) {
        matrix.startVec(v);
        int last = -1;
        for (int e = outer[first[v]]; e < outer[first[v] + 1]; ++e) {
            if (vertex[rows[e]] == last) continue;
            last = vertex[rows[e]];
            matrix.insertBack(last, v) = 1;
        }
    }
    matrix.finalize();
}

}  // namespace solver_detail

/// A fill-reducing ordering of particles instead of single unknowns, with Eigen's ordering
/// interface for its symmetric solvers: columns of the same pattern are ordered as one, by
/// `Ordering` on the compressed graph (C. Ashcraft, "Compressed graphs and the minimum degree
/// algorithm", 1995).
template <class Ordering = Eigen::AMDOrdering<int>>
class BlockOrdering {
public:
    using PermutationType = typename Ordering::PermutationType;

    /// @param A  compressed, with both triangles of a symmetric pattern, rows ascending
    template <class Scalar>
    void operator()(const SparseMatrix<Scalar>& A, PermutationType& permutation) const {
        const solver_detail::CompressedGraph graph(A);
        PermutationType vertices;
        Ordering()(graph.matrix, vertices);
        permutation.resize(A.cols());
        graph.expand(vertices.indices().data(), permutation.indices());
    }
};

}  // namespace taut
