// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "../core/assert.hpp"
#include "block_pattern.hpp"
#include "combination.hpp"
#include "spring_set.hpp"

namespace taut {

/// The symmetric sparsity pattern of a spring system's matrices, one Dim × Dim block for each pair
/// of free particles that a spring joins, and their assembly in place.
///
/// Built once for a topology; both triangles are stored, with structural zeros kept, so that K, D
/// and every step matrix have the same pattern.
template <class Scalar, int Dim>
class TangentMatrix {
public:
    using Matrix = SparseMatrix<Scalar>;
    using Block = Eigen::Matrix<Scalar, Dim, Dim>;

    /// @param system  a SpringSystem; none of it is kept
    template <class System>
    explicit TangentMatrix(const System& system);

    /// The free particles, ascending: block j of the matrix belongs to particle free()[j].
    const std::vector<Index>& free() const { return free_; }
    /// N, the free degrees of freedom.
    Index size() const { return Dim * static_cast<Index>(free_.size()); }

    /// An N × N matrix of zeros with this pattern.
    Matrix zero() const { return pattern_.template zero<Scalar, Dim>(); }

    /// A ← the sum c at x, into a matrix made by zero().
    template <class System>
    void assemble(const System& system, const Points<Scalar, Dim>& x, const Combination& c,
                  Matrix& A) const;

private:
    struct Slots {
        int ab;  // place of block (a, b) in column b, or -1 when an end is pinned
        int ba;  // place of block (b, a) in column a
    };
    std::vector<Index> free_;    // free particles, ascending
    std::vector<Index> column_;  // particle → block column, or -1
    BlockPattern pattern_;
    std::vector<int> diagonal_;  // block column → place of its diagonal block
    std::vector<Slots> slots_;   // one for each spring, in the order of for_each_spring
};

template <class Scalar, int Dim>
template <class System>
TangentMatrix<Scalar, Dim>::TangentMatrix(const System& system) {
    column_.assign(static_cast<std::size_t>(system.size()), Index(-1));
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        column_[i] = static_cast<Index>(free_.size());
        free_.push_back(i);
    }
    const auto both_free = [this](Index a, Index b) { return column_[a] >= 0 && column_[b] >= 0; };
    pattern_ = BlockPattern(static_cast<Index>(free_.size()), [&](const auto& visit) {
        system.for_each_spring([&](Index a, Index b) {
            if (both_free(a, b)) visit(column_[a], column_[b]);
        });
    });
    for (std::size_t j = 0; j < free_.size(); ++j) {
        diagonal_.push_back(pattern_.place(static_cast<Index>(j), static_cast<Index>(j)));
    }
    system.for_each_spring([&](Index a, Index b) {
        slots_.push_back(both_free(a, b) ? Slots{pattern_.place(column_[a], column_[b]),
                                                 pattern_.place(column_[b], column_[a])}
                                         : Slots{-1, -1});
    });
}

template <class Scalar, int Dim>
template <class System>
void TangentMatrix<Scalar, Dim>::assemble(const System& system, const Points<Scalar, Dim>& x,
                                          const Combination& c, Matrix& A) const {
    TAUT_ASSERT(A.nonZeros() == Dim * Dim * pattern_.blocks(), "the matrix must be made by zero()");
    std::fill_n(A.valuePtr(), A.nonZeros(), Scalar(0));
    const auto rayleigh = system.rayleigh();
    const Scalar on_mass = static_cast<Scalar>(c.mass() + c.damping() * rayleigh.mass_proportional);
    const Scalar on_k = static_cast<Scalar>(c.stiffness());
    const Scalar on_k_plus = static_cast<Scalar>(c.projected());
    const Scalar on_rayleigh = static_cast<Scalar>(c.damping() * rayleigh.stiffness_proportional);
    const Scalar on_bound = static_cast<Scalar>(c.damping() * system.graph_damping());
    const Scalar on_damper = static_cast<Scalar>(c.damping());
    std::size_t s = 0;
    system.for_each_tangent(x, [&](const SpringTangent<Scalar, Dim>& raw) {
        const Slots slots = slots_[s++];
        const Index a = column_[raw.a];
        const Index b = column_[raw.b];
        const auto plus = raw.projected();
        const Scalar graph = on_bound * raw.bound;
        const Scalar axial = on_k * raw.axial + on_k_plus * plus.axial + on_rayleigh * plus.axial +
                             on_damper * raw.damping + graph;
        const Scalar transverse = on_k * raw.transverse + on_k_plus * plus.transverse +
                                  on_rayleigh * plus.transverse + graph;
        const Block P = spring_block(raw.d, axial, transverse);
        if (a >= 0) pattern_.add(A, diagonal_[a], a, P);
        if (b >= 0) pattern_.add(A, diagonal_[b], b, P);
        if (slots.ab >= 0) {
            pattern_.template add<Scalar, Dim>(A, slots.ab, b, -P);
            pattern_.template add<Scalar, Dim>(A, slots.ba, a, -P);
        }
    });
    for (std::size_t j = 0; j < free_.size(); ++j) {
        const Block diagonal = on_mass * system.mass(free_[j]) * Block::Identity();
        pattern_.add(A, diagonal_[j], static_cast<Index>(j), diagonal);
    }
}

}  // namespace taut
