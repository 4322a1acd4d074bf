// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "../../model/spring_system.hpp"

namespace taut::detail {

/// The linear system of an implicit step x⁺ = x + q + τΔv whose formula reaches further back than
/// (x, v), for Δv = v⁺ − v:
///     (M + τD + τ²K) Δv = M p + τ (f(x, v) − K q),  K⁺ for K where springs are behind it [T27].
/// p, m/s, and q, m, both Dim × n, carry the history; implicit Euler is p = 0, q = hv, τ = h.
/// This one is for matrices: constant, so the step matrix changes with τ alone.
template <class System>
class MultistepEquation {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    /// @returns whether the sparsity pattern is new
    bool update_pattern(const System& system) {
        if (A_.rows() == system.size() && revision_ == system.revision()) return false;
        revision_ = system.revision();
        assemble(system, 1);
        tau_ = 0;
        return true;
    }
    /// @returns whether the values are new
    bool update_values(const System& system, const State&, Scalar tau) {
        if (tau == tau_) return false;
        assemble(system, tau);
        tau_ = tau;
        return true;
    }
    const SparseMatrix<Scalar>& matrix() const { return A_; }

    void load(const System& system, const State& state, Scalar tau, const Points<Scalar, 1>& p,
              const Points<Scalar, 1>& q, VectorX<Scalar>& b) {
        system.force(state, f_);
        b = system.mass().cwiseProduct(p.transpose()) + tau * f_.transpose();
        b.noalias() -= tau * (system.stiffness() * q.transpose());
    }
    void add_to_velocity(const VectorX<Scalar>& dv, State& state) const {
        state.v += dv.transpose();
    }
    /// The particle of a degree of freedom.
    Index particle(Index dof) const { return dof; }

private:
    void assemble(const System& system, Scalar tau) {
        SparseMatrix<Scalar> mass(system.size(), system.size());
        mass.setIdentity();
        mass.diagonal() = system.mass();
        A_ = tau * system.damping() + (tau * tau) * system.stiffness();
        A_ += mass;
        A_.makeCompressed();
    }

    Scalar tau_ = 0;              // of the values in A_, s
    std::uint64_t revision_ = 0;  // the system's
    SparseMatrix<Scalar> A_;      // M + τD + τ²K
    Points<Scalar, 1> f_;         // 1 × N, N
};

/// For springs: assembled in place at every pose; the pattern changes with the topology alone.
template <class Scalar, int Dim, class... Laws>
class MultistepEquation<SpringSystem<Scalar, Dim, Laws...>> {
public:
    using System = SpringSystem<Scalar, Dim, Laws...>;
    using State = typename System::State;

    bool update_pattern(const System& system) {
        if (pattern_ && topology_ == system.topology_revision()) return false;
        pattern_.emplace(system);
        A_ = pattern_->zero();
        topology_ = system.topology_revision();
        return true;
    }
    bool update_values(const System& system, const State& state, Scalar tau) {
        const double step = static_cast<double>(tau);
        pattern_->assemble(system, state.x, {1, step * step, step}, A_);
        return true;
    }
    const SparseMatrix<Scalar>& matrix() const { return A_; }

    void load(const System& system, const State& state, Scalar tau, const Points<Scalar, Dim>& p,
              const Points<Scalar, Dim>& q, VectorX<Scalar>& b) {
        system.force(state, f_);
        system.for_each_tangent(state.x, [&](const SpringTangent<Scalar, Dim>& raw) {
            const auto t = raw.projected();
            const Eigen::Matrix<Scalar, Dim, 1> dq = q.col(t.b) - q.col(t.a);
            const Eigen::Matrix<Scalar, Dim, 1> pull =
                t.transverse * dq + (t.axial - t.transverse) * t.d.dot(dq) * t.d;
            f_.col(t.a) += pull;
            f_.col(t.b) -= pull;
        });
        const auto& free = pattern_->free();
        b.resize(pattern_->size());
        for (std::size_t j = 0; j < free.size(); ++j) {
            b.template segment<Dim>(Dim * static_cast<Index>(j)) =
                system.mass(free[j]) * p.col(free[j]) + tau * f_.col(free[j]);
        }
    }
    void add_to_velocity(const VectorX<Scalar>& dv, State& state) const {
        const auto& free = pattern_->free();
        for (std::size_t j = 0; j < free.size(); ++j) {
            state.v.col(free[j]) += dv.template segment<Dim>(Dim * static_cast<Index>(j));
        }
    }
    Index particle(Index dof) const { return pattern_->free()[dof / Dim]; }

private:
    std::optional<TangentMatrix<Scalar, Dim>> pattern_;
    std::uint64_t topology_ = 0;
    SparseMatrix<Scalar> A_;  // M + τD + τ²K⁺
    Points<Scalar, Dim> f_;   // Dim × n, N
};

}  // namespace taut::detail
