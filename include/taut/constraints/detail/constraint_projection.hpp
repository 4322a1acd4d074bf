// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "../../model/free_particles.hpp"
#include "../particle_constraints.hpp"

namespace taut::integrator_detail {

/// The linear system A Δv = b of an implicit step under constraints on particles. With S the
/// projector on what they leave free and z the Δv that they prescribe,
///     (S A S + I − S) y = S(b − A z),  Δv = y + z  [T31].
/// The matrix is definite whenever A is, and has its pattern. Conjugate gradients on it never leave
/// the range of S: they are the filtered ones of D. Baraff and A. Witkin (1998).
template <class Scalar, int Dim>
class ConstraintProjection {
public:
    using Constraints = ParticleConstraints<Scalar, Dim>;

    /// For a new pattern of A, which must consist of full Dim × Dim blocks, one for each of these.
    void update_pattern(const FreeParticles& particles) {
        particles_ = particles;
        free_.resize(static_cast<std::size_t>(particles.count()));
    }
    /// For the next step, from velocities v, Dim × n. Those of pinned particles have no effect.
    void begin(const Constraints& constraints, const Points<Scalar, Dim>& v) {
        active_ = !constraints.held().empty();
        if (!active_) return;
        std::fill(free_.begin(), free_.end(), Block(Block::Identity()));
        z_.setZero(Dim * static_cast<Index>(free_.size()));
        for (const auto& [particle, held] : constraints.held()) {
            const Index j = block(particle);
            if (j < 0) continue;
            z_.template segment<Dim>(Dim * j) =
                held.velocity() - held.directions * (held.directions.transpose() * v.col(particle));
            free_[static_cast<std::size_t>(j)] = held.free();
        }
    }
    bool active() const { return active_; }
    /// The particle's place among the blocks of the matrix, or −1.
    Index block(Index particle) const { return particles_.place(particle); }

    /// S A S + I − S, kept until the next call.
    const SparseMatrix<Scalar>& matrix(const SparseMatrix<Scalar>& A);
    /// right ← S(b − A z).
    void reduce(const SparseMatrix<Scalar>& A, const VectorX<Scalar>& b,
                VectorX<Scalar>& right) const {
        right = b;
        right.noalias() -= A * z_;
        project(right);
    }
    /// dv ← S dv + z.
    void complete(VectorX<Scalar>& dv) const {
        project(dv);
        dv += z_;
    }
    /// b ← S b.
    void project(VectorX<Scalar>& b) const {
        for (std::size_t j = 0; j < free_.size(); ++j) {
            auto segment = b.template segment<Dim>(Dim * static_cast<Index>(j));
            segment = (free_[j] * segment).eval();
        }
    }

private:
    using Block = typename Constraints::Block;
    using Vector = typename Constraints::Vector;

    bool active_ = false;
    FreeParticles particles_;      // of the blocks of the matrix
    std::vector<Block> free_;      // S of each block; identity where nothing is held
    VectorX<Scalar> z_;            // m/s
    SparseMatrix<Scalar> matrix_;  // S A S + I − S
};

template <class Scalar, int Dim>
const SparseMatrix<Scalar>& ConstraintProjection<Scalar, Dim>::matrix(
    const SparseMatrix<Scalar>& A) {
    matrix_ = A;
    const auto* outer = matrix_.outerIndexPtr();
    for (std::size_t j = 0; j < free_.size(); ++j) {
        const Index column = Dim * static_cast<Index>(j);
        for (Index slot = 0; slot < outer[column + 1] - outer[column]; slot += Dim) {
            const auto i =
                static_cast<std::size_t>(matrix_.innerIndexPtr()[outer[column] + slot] / Dim);
            Block block;
            for (int c = 0; c < Dim; ++c) {
                block.col(c) =
                    Eigen::Map<const Vector>(matrix_.valuePtr() + outer[column + c] + slot);
            }
            block = (free_[i] * block * free_[j]).eval();
            if (i == j) block += Block::Identity() - free_[j];
            for (int c = 0; c < Dim; ++c) {
                Eigen::Map<Vector>(matrix_.valuePtr() + outer[column + c] + slot) = block.col(c);
            }
        }
    }
    return matrix_;
}

}  // namespace taut::integrator_detail
