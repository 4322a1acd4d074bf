// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "../core/method.hpp"
#include "../model/particle_constraints.hpp"
#include "detail/step_equation.hpp"
#include "detail/step_loop.hpp"

namespace taut {

/// Implicit Euler with constraints on particles (D. Baraff, A. Witkin, "Large steps in cloth
/// simulation", SIGGRAPH 1998), held exactly by a direct solve. With A = M + hD + h²K⁺, b the right
/// side of [T6] for Δv, S the projector on what is free and z what is prescribed,
///     (S A S + I − S) y = S(b − A z),   Δv = y + z,   v⁺ = v + Δv,  x⁺ = x + h v⁺.
///
/// The matrix is definite whenever A is. A Δv − b is zero along S; along the constraints it is
/// their impulse: constraint_forces() is that over h, for friction or to decide on a release.
/// @tparam Solver  as for ImplicitEuler
template <class System, class Solver = Eigen::SimplicialLLT<SparseMatrix<typename System::Scalar>>>
class ConstrainedImplicitEuler {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    using Constraints = ParticleConstraints<Scalar, Dim>;
    static constexpr Method method = Method::implicit_euler;
    static constexpr int order = 1;

    static_assert((require_system<System>(), true));
    static_assert((require_solver<Solver, Scalar>(), true));
    static_assert(!std::is_same_v<std::decay_t<System>, GeneralLinearSystem<Scalar>>,
                  "taut::ConstrainedImplicitEuler: the system must be symmetric");

    /// Keeps a reference: the system must outlive the stepper.
    explicit ConstrainedImplicitEuler(const System& system) : system_(&system) {}
    explicit ConstrainedImplicitEuler(const System&&) = delete;

    /// Change them between steps at will. Those of pinned particles have no effect.
    Constraints& constraints() { return constraints_; }

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before; a constraint on a particle that the system does not have is
    /// invalid_state, at that particle. The report's residual is that of the last linear solve,
    /// relative to its right-hand side.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1) {
        if (!constraints_.held().empty()) {
            const Index last = constraints_.held().rbegin()->first;
            if (last >= system_->size()) return {Status::invalid_state, 0, 0, last};
        }
        return loop_.run(*system_, state, h, count, [&](State& own) { return advance(own, h); });
    }
    /// Force of the constraints on their particles in the last step, N, Dim × n; zero elsewhere.
    const Points<Scalar, Dim>& constraint_forces() const { return forces_; }

private:
    using Block = typename Constraints::Block;
    using Vector = typename Constraints::Vector;

    Report advance(State& state, Scalar h);
    void project(VectorX<Scalar>& b) const;
    void project_matrix();

    const System* system_;
    Constraints constraints_;
    detail::StepLoop<State> loop_;
    detail::StepEquation<System> equation_;
    Solver solver_;
    std::vector<Index> block_;     // particle → block of the matrix, or −1
    SparseMatrix<Scalar> matrix_;  // S A S + I − S
    std::vector<Block> free_;      // S of each block; identity where nothing is held
    VectorX<Scalar> b_;            // N·s
    VectorX<Scalar> z_;            // m/s
    VectorX<Scalar> right_;        // S(b − A z), N·s
    VectorX<Scalar> dv_;           // m/s
    Points<Scalar, Dim> forces_;   // Dim × n, N
};

template <class System, class Solver>
void ConstrainedImplicitEuler<System, Solver>::project(VectorX<Scalar>& b) const {
    for (std::size_t j = 0; j < free_.size(); ++j) {
        auto segment = b.template segment<Dim>(Dim * static_cast<Index>(j));
        segment = (free_[j] * segment).eval();
    }
}

/// Block (i, j) of A becomes S_i A_ij S_j. Every block of the pattern is a full Dim × Dim one.
template <class System, class Solver>
void ConstrainedImplicitEuler<System, Solver>::project_matrix() {
    matrix_ = equation_.matrix();
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
}

template <class System, class Solver>
Report ConstrainedImplicitEuler<System, Solver>::advance(State& state, Scalar h) {
    if (equation_.update_pattern(*system_)) {
        solver_.analyzePattern(equation_.matrix());
        block_.assign(static_cast<std::size_t>(system_->size()), Index(-1));
        free_.resize(static_cast<std::size_t>(equation_.matrix().rows() / Dim));
        for (std::size_t j = 0; j < free_.size(); ++j) {
            const Index particle = equation_.particle(Dim * static_cast<Index>(j));
            block_[static_cast<std::size_t>(particle)] = static_cast<Index>(j);
        }
    }
    equation_.update_values(*system_, state, h);
    const auto& A = equation_.matrix();
    equation_.load(*system_, state, h, h, state.v, b_);

    std::fill(free_.begin(), free_.end(), Block(Block::Identity()));
    z_.setZero(A.rows());
    for (const auto& [particle, held] : constraints_.held()) {
        const Index j = block_[static_cast<std::size_t>(particle)];
        if (j < 0) continue;
        const Vector known =
            held.directions * (held.directions.transpose() * state.v.col(particle));
        z_.template segment<Dim>(Dim * j) = held.velocity() - known;
        free_[static_cast<std::size_t>(j)] = held.free();
    }
    project_matrix();
    solver_.factorize(matrix_);
    if (solver_.info() != Eigen::Success) return {Status::not_positive_definite};
    right_ = b_;
    right_.noalias() -= A * z_;
    project(right_);
    dv_ = solver_.solve(right_);
    if (solver_.info() != Eigen::Success || !dv_.allFinite()) return {Status::solver_failed};
    project(dv_);  // rounding out of the constraints
    Report report;
    const Scalar norm = right_.norm();
    right_.noalias() -= matrix_ * dv_;
    report.residual = norm > 0 ? static_cast<double>(right_.norm() / norm) : 0;

    dv_ += z_;
    b_ = -b_;
    b_.noalias() += A * dv_;
    forces_.setZero(Dim, system_->size());
    for (const auto& [particle, held] : constraints_.held()) {
        const Index j = block_[static_cast<std::size_t>(particle)];
        if (j >= 0) forces_.col(particle) = b_.template segment<Dim>(Dim * j) / h;
    }
    equation_.add_to_velocity(dv_, state);
    state.x += h * state.v;
    return report;
}

}  // namespace taut
