// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/buffer.hpp"
#include "../core/types.hpp"

namespace taut {

/// The particles of a system that are not pinned, in ascending order. A vector over their degrees
/// of freedom, `values` below, has the Dim coordinates of the j-th of them from Dim·j on.
class FreeParticles {
public:
    FreeParticles() = default;
    /// @param system  with size() and is_pinned(i); none of it is kept
    template <class System>
    explicit FreeParticles(const System& system) {
        for (Index i = 0; i < system.size(); ++i) append(system.is_pinned(i));
    }
    /// All of `particles`, none of which is pinned.
    static FreeParticles all(Index particles) {
        FreeParticles free;
        for (Index i = 0; i < particles; ++i) free.append(false);
        return free;
    }

    /// The number of free particles.
    Index count() const { return static_cast<Index>(list_.size()); }
    /// The number of particles, pinned ones included.
    Index particles() const { return static_cast<Index>(place_.size()); }
    /// The j-th free particle, 0 ≤ j < count().
    Index operator[](Index j) const { return list_[j]; }
    /// The j of a particle, or −1 if it is pinned.
    Index place(Index particle) const { return place_[particle]; }
    /// The first free particle, for loops over them.
    auto begin() const { return list_.begin(); }
    /// The end of the free particles.
    auto end() const { return list_.end(); }

    /// values ← the columns of the free particles of `points`, Dim × particles().
    template <class Matrix, class Values>
    void gather(const Matrix& points, Values& values) const {
        constexpr int Dim = Matrix::RowsAtCompileTime;
        values.resize(Dim * count());
        for (Index j = 0; j < count(); ++j) {
            values.template segment<Dim>(Dim * j) = points.col(list_[j]);
        }
    }
    /// The columns of the free particles ← values; the others stay.
    template <class Values, class Matrix>
    void scatter(const Values& values, Matrix& points) const {
        constexpr int Dim = Matrix::RowsAtCompileTime;
        for (Index j = 0; j < count(); ++j) {
            points.col(list_[j]) = values.template segment<Dim>(Dim * j);
        }
    }
    /// Adds t·values to the columns of the free particles.
    template <class Scalar, class Values, class Matrix>
    void add(Scalar t, const Values& values, Matrix& points) const {
        constexpr int Dim = Matrix::RowsAtCompileTime;
        for (Index j = 0; j < count(); ++j) {
            points.col(list_[j]) += t * values.template segment<Dim>(Dim * j);
        }
    }

private:
    void append(bool pinned) {
        place_.push_back(pinned ? Index(-1) : count());
        if (!pinned) list_.push_back(particles() - 1);
    }

    Buffer<Index> list_;   // ascending
    Buffer<Index> place_;  // particle → its place in list_, or −1
};

}  // namespace taut
