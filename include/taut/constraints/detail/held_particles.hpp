// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "../../core/status.hpp"
#include "../../network/free_particles.hpp"
#include "../particle_constraints.hpp"

namespace taut::integrator_detail {

/// The linear system A Δv = b of an implicit step under constraints on particles. With S the
/// projector on what they leave free and z the Δv that they prescribe,
///     (S A S + I − S) y = S(b − A z),  Δv = y + z  [T31].
/// The matrix is definite whenever A is, and has its pattern. Conjugate gradients on it never leave
/// the range of S: they are the filtered ones of D. Baraff and A. Witkin (1998).
///
/// A must consist of full Dim × Dim blocks, one for each free particle. For the functions see
/// NothingHeld.
template <class Scalar, int Dim>
class HeldParticles {
public:
    using Constraints = ParticleConstraints<Scalar, Dim>;
    using Forces = Points<Scalar, Dim>;

    Constraints& constraints() { return constraints_; }
    const Constraints& constraints() const { return constraints_; }
    /// Of the last step, Dim × n, N; 0 columns if it had none, or failed.
    const Forces& forces() const { return forces_; }
    /// Whether the particles exist.
    Report examine(Index particles) const {
        const auto& held = constraints_.held();
        if (held.empty() || held.rbegin()->first < particles) return {};
        return {Status::invalid_state, 0, 0, held.rbegin()->first};
    }
    /// Sets forces() by the force that is missing on particles, N: force(particle).
    template <class Force>
    void set_forces(Force&& force) {
        forces_.setZero(Dim, particles_->particles());
        for (const auto& [particle, held] : constraints_.held()) {
            forces_.col(particle) =
                held.directions * (held.directions.transpose() * force(particle));
        }
    }
    void clear_forces() { forces_.resize(Eigen::NoChange, 0); }

    void begin(const FreeParticles& particles, const Forces& v);
    bool active() const { return !constraints_.held().empty(); }
    const SparseMatrix<Scalar>& matrix(const SparseMatrix<Scalar>& A);
    const VectorX<Scalar>& reduce(const SparseMatrix<Scalar>& A, const VectorX<Scalar>& b);
    void complete(VectorX<Scalar>& dv) const {
        if (!active()) return;
        project(dv);
        dv += z_;
    }
    void settle(VectorX<Scalar>& open, Scalar h);

private:
    using Block = typename Constraints::Block;
    using Vector = typename Constraints::Vector;

    /// b ← S b.
    void project(VectorX<Scalar>& b) const;

    Constraints constraints_;
    const FreeParticles* particles_ = nullptr;  // of the blocks of the matrix, in this step
    std::vector<Block> free_;                   // S of each block; identity where nothing is held
    VectorX<Scalar> z_;                         // m/s
    VectorX<Scalar> right_;                     // N·s
    SparseMatrix<Scalar> matrix_;               // S A S + I − S
    Forces forces_;
};

template <class Scalar, int Dim>
void HeldParticles<Scalar, Dim>::begin(const FreeParticles& particles, const Forces& v) {
    particles_ = &particles;
    clear_forces();
    if (!active()) return;
    free_.assign(static_cast<std::size_t>(particles.count()), Block(Block::Identity()));
    z_.setZero(Dim * particles.count());
    for (const auto& [particle, held] : constraints_.held()) {
        const Index j = particles.place(particle);
        if (j < 0) continue;  // pinned
        z_.template segment<Dim>(Dim * j) =
            held.velocity() - held.directions * (held.directions.transpose() * v.col(particle));
        free_[static_cast<std::size_t>(j)] = held.free();
    }
}

template <class Scalar, int Dim>
const VectorX<Scalar>& HeldParticles<Scalar, Dim>::reduce(const SparseMatrix<Scalar>& A,
                                                          const VectorX<Scalar>& b) {
    if (!active()) return b;
    right_ = b;
    right_.noalias() -= A * z_;
    project(right_);
    return right_;
}

template <class Scalar, int Dim>
void HeldParticles<Scalar, Dim>::settle(VectorX<Scalar>& open, Scalar h) {
    if (!active()) return;
    // What the springs leave open along the constraints is for these to give.
    set_forces([&](Index particle) -> Vector {
        const Index j = particles_->place(particle);
        if (j < 0) return Vector::Zero();
        return -open.template segment<Dim>(Dim * j) / h;
    });
    project(open);
}

template <class Scalar, int Dim>
void HeldParticles<Scalar, Dim>::project(VectorX<Scalar>& b) const {
    for (std::size_t j = 0; j < free_.size(); ++j) {
        auto segment = b.template segment<Dim>(Dim * static_cast<Index>(j));
        segment = (free_[j] * segment).eval();
    }
}

/// S A S + I − S, kept until the next call.
template <class Scalar, int Dim>
const SparseMatrix<Scalar>& HeldParticles<Scalar, Dim>::matrix(const SparseMatrix<Scalar>& A) {
    if (!active()) return A;
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
