// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>

#include "../core/assert.hpp"
#include "../core/buffer.hpp"
#include "block_pattern.hpp"
#include "combination.hpp"
#include "free_particles.hpp"
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

    /// The free particles: block j of the matrix belongs to particle free()[j].
    const FreeParticles& free() const { return free_; }
    /// N, the free degrees of freedom.
    Index size() const { return Dim * free_.count(); }

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
    FreeParticles free_;
    BlockPattern pattern_;
    Buffer<int> diagonal_;  // block column → place of its diagonal block
    Buffer<Slots> slots_;   // one for each spring, in the order of for_each_spring
};

template <class Scalar, int Dim>
template <class System>
TangentMatrix<Scalar, Dim>::TangentMatrix(const System& system) : free_(system) {
    const auto for_each_pair = [&](auto&& visit) {  // of columns, −1 for a pinned end
        system.for_each_spring([&](Index a, Index b) { visit(free_.place(a), free_.place(b)); });
    };
    pattern_ = BlockPattern(free_.count(), [&](const auto& visit) {
        for_each_pair([&](Index a, Index b) {
            if (a >= 0 && b >= 0) visit(a, b);
        });
    });
    for (Index j = 0; j < free_.count(); ++j) diagonal_.push_back(pattern_.place(j, j));
    for_each_pair([&](Index a, Index b) {
        slots_.push_back(a >= 0 && b >= 0 ? Slots{pattern_.place(a, b), pattern_.place(b, a)}
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
    const Scalar on_damper = static_cast<Scalar>(c.damping());
    std::size_t s = 0;
    system.for_each_tangent(x, [&](const SpringTangent<Scalar, Dim>& raw) {
        const Slots own = slots_[s++];
        const Index a = free_.place(raw.a);
        const Index b = free_.place(raw.b);
        const auto plus = raw.projected();
        const Scalar axial = on_k * raw.axial + on_k_plus * plus.axial + on_rayleigh * plus.axial +
                             on_damper * raw.damping;
        const Scalar transverse =
            on_k * raw.transverse + on_k_plus * plus.transverse + on_rayleigh * plus.transverse;
        const Block P = spring_block(raw.d, axial, transverse);
        if (a >= 0) pattern_.add(A, diagonal_[a], a, P);
        if (b >= 0) pattern_.add(A, diagonal_[b], b, P);
        if (own.ab >= 0) {
            pattern_.template add<Scalar, Dim>(A, own.ab, b, -P);
            pattern_.template add<Scalar, Dim>(A, own.ba, a, -P);
        }
    });
    for (Index j = 0; j < free_.count(); ++j) {
        const Block diagonal = on_mass * system.mass(free_[j]) * Block::Identity();
        pattern_.add(A, diagonal_[j], j, diagonal);
    }
}

}  // namespace taut
