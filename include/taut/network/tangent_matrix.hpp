// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

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
    explicit TangentMatrix(const System& system) : free_(system) {
        Buffer<BlockPair> pairs;
        system.for_each_spring([&](Index a, Index b) {
            pairs.push_back({static_cast<int>(free_.place(a)), static_cast<int>(free_.place(b))});
        });
        set_pattern(pairs);
    }

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

    /// f ← f + s K⁺(u_b − u_a) on the end a of a spring, and the opposite on b; u and f Dim × n.
    static void add_product(const SpringTangent<Scalar, Dim>& spring, Scalar s,
                            const Points<Scalar, Dim>& u, Points<Scalar, Dim>& f);

private:
    struct Slots {
        int ab;  // place of block (a, b) in column b, or -1 when an end is pinned
        int ba;  // place of block (b, a) in column a
    };
    /// A combination's factors in Scalar.
    struct Factors {
        Scalar k, plus, rayleigh, damper;
    };
    // These are no templates of the system, and compiled once for all of them.
    void set_pattern(const Buffer<BlockPair>& pairs);
    void add_spring(const SpringTangent<Scalar, Dim>& raw, Slots own, const Factors& on,
                    Matrix& A) const;
    void add_mass(Index j, Scalar mass, Matrix& A) const;

    FreeParticles free_;
    BlockPattern pattern_;
    Buffer<int> diagonal_;  // block column → place of its diagonal block
    Buffer<Slots> slots_;   // one for each spring, in the order of for_each_spring
};

template <class Scalar, int Dim>
void TangentMatrix<Scalar, Dim>::set_pattern(const Buffer<BlockPair>& pairs) {
    pattern_ = BlockPattern(free_.count(), pairs);
    for (Index j = 0; j < free_.count(); ++j) diagonal_.push_back(pattern_.place(j, j));
    for (const auto& [a, b] : pairs) {
        slots_.push_back(a >= 0 && b >= 0 ? Slots{pattern_.place(a, b), pattern_.place(b, a)}
                                          : Slots{-1, -1});
    }
}

template <class Scalar, int Dim>
template <class System>
void TangentMatrix<Scalar, Dim>::assemble(const System& system, const Points<Scalar, Dim>& x,
                                          const Combination& c, Matrix& A) const {
    TAUT_ASSERT(A.nonZeros() == Dim * Dim * pattern_.blocks(), "the matrix must be made by zero()");
    std::fill_n(A.valuePtr(), A.nonZeros(), Scalar(0));
    const auto rayleigh = system.rayleigh();
    const Scalar on_mass = static_cast<Scalar>(c.mass() + c.damping() * rayleigh.mass_proportional);
    const Factors on{static_cast<Scalar>(c.stiffness()), static_cast<Scalar>(c.projected()),
                     static_cast<Scalar>(c.damping() * rayleigh.stiffness_proportional),
                     static_cast<Scalar>(c.damping())};
    std::size_t s = 0;
    system.for_each_tangent(
        x, [&](const SpringTangent<Scalar, Dim>& raw) { add_spring(raw, slots_[s++], on, A); });
    for (Index j = 0; j < free_.count(); ++j) add_mass(j, on_mass * system.mass(free_[j]), A);
}

template <class Scalar, int Dim>
void TangentMatrix<Scalar, Dim>::add_spring(const SpringTangent<Scalar, Dim>& raw, Slots own,
                                            const Factors& on, Matrix& A) const {
    const Index a = free_.place(raw.a);
    const Index b = free_.place(raw.b);
    const auto plus = raw.projected();
    const Scalar axial = on.k * raw.axial + on.plus * plus.axial + on.rayleigh * plus.axial +
                         on.damper * raw.damping;
    const Scalar transverse =
        on.k * raw.transverse + on.plus * plus.transverse + on.rayleigh * plus.transverse;
    const Block P = spring_block(raw.d, axial, transverse);
    if (a >= 0) pattern_.add(A, diagonal_[a], a, P);
    if (b >= 0) pattern_.add(A, diagonal_[b], b, P);
    if (own.ab >= 0) {
        pattern_.template add<Scalar, Dim>(A, own.ab, b, -P);
        pattern_.template add<Scalar, Dim>(A, own.ba, a, -P);
    }
}

template <class Scalar, int Dim>
void TangentMatrix<Scalar, Dim>::add_mass(Index j, Scalar mass, Matrix& A) const {
    const Block diagonal = mass * Block::Identity();
    pattern_.add(A, diagonal_[j], j, diagonal);
}

template <class Scalar, int Dim>
void TangentMatrix<Scalar, Dim>::add_product(const SpringTangent<Scalar, Dim>& spring, Scalar s,
                                             const Points<Scalar, Dim>& u, Points<Scalar, Dim>& f) {
    const auto t = spring.projected();
    const Eigen::Matrix<Scalar, Dim, 1> du = u.col(t.b) - u.col(t.a);
    const Eigen::Matrix<Scalar, Dim, 1> force = s * spring_product(t.d, t.axial, t.transverse, du);
    f.col(t.a) += force;
    f.col(t.b) -= force;
}

}  // namespace taut
