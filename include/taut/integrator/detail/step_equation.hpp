// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "../../core/status.hpp"
#include "../../model/spring_system.hpp"

namespace taut::integrator_detail {

/// The linear system of an implicit step x⁺ = x + su + τΔv for Δv = v⁺ − v [T6], [T27]:
///     (M + τD + τ²K) Δv = τ (f(x, v) − sK u),  K⁺ for K where springs are behind it.
/// Implicit Euler of step h has s = τ = h, u = v; BDF2 adds the momentum of its history.
/// This one is for matrices: constant, so the step matrix changes with τ alone.
template <class System>
class StepEquation {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr bool constant = true;  ///< for one τ the values never change

    /// @returns whether the sparsity pattern is new
    bool update_pattern(const System& system) {
        if (A_.rows() == system.size() && revision_ == system.revision()) return false;
        free_ = FreeParticles::all(system.size());
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

    /// b ← τ (f − sK u).
    void load(const System& system, const State& state, Scalar tau, Scalar s,
              const Points<Scalar, 1>& u, VectorX<Scalar>& b) {
        system.force(state, f_);
        b = tau * f_.transpose();
        b.noalias() -= (tau * s) * (system.stiffness() * u.transpose());
    }
    /// b ← b + M p, p in m/s.
    void add_momentum(const System& system, const Points<Scalar, 1>& p, VectorX<Scalar>& b) const {
        b += system.mass().cwiseProduct(p.transpose());
    }
    void add_to_velocity(const VectorX<Scalar>& dv, State& state) const {
        state.v += dv.transpose();
    }
    /// The particles of the blocks of matrix(): each degree of freedom is one.
    const FreeParticles& free() const { return free_; }

private:
    void assemble(const System& system, Scalar tau) {
        SparseMatrix<Scalar> mass(system.size(), system.size());
        mass.setIdentity();
        mass.diagonal() = system.mass();
        A_ = tau * system.damping() + (tau * tau) * system.stiffness();
        A_ += mass;
        A_.makeCompressed();
    }

    FreeParticles free_;
    Scalar tau_ = 0;              // of the values in A_, s
    std::uint64_t revision_ = 0;  // the system's
    SparseMatrix<Scalar> A_;      // M + τD + τ²K
    Points<Scalar, 1> f_;         // 1 × N, N
};

/// For springs: assembled in place at every pose; the pattern changes with the topology alone.
template <class Scalar, int Dim, class... Laws>
class StepEquation<SpringSystem<Scalar, Dim, Laws...>> {
public:
    using System = SpringSystem<Scalar, Dim, Laws...>;
    using State = typename System::State;
    static constexpr bool constant = false;

    bool update_pattern(const System& system) {
        if (pattern_ && topology_ == system.topology_revision()) return false;
        pattern_.emplace(system);
        A_ = pattern_->zero();
        topology_ = system.topology_revision();
        return true;
    }
    bool update_values(const System& system, const State& state, Scalar tau) {
        const double step = static_cast<double>(tau);
        pattern_->assemble(system, state.x,
                           matrices::M + step * matrices::D + step * step * matrices::K_plus, A_);
        return true;
    }
    /// A ← M + hD(x₀) + h²K(x), the second derivative of the step's objective at x; K⁺ for K if
    /// `project`.
    void update_values(const System& system, const Points<Scalar, Dim>& x0,
                       const Points<Scalar, Dim>& x, Scalar h, bool project) {
        const double step = static_cast<double>(h);
        if (B_.nonZeros() != A_.nonZeros()) B_ = A_;
        pattern_->assemble(system, x0, matrices::M + step * matrices::D, B_);
        pattern_->assemble(system, x, step * step * (project ? matrices::K_plus : matrices::K), A_);
        Eigen::Map<VectorX<Scalar>>(A_.valuePtr(), A_.nonZeros()) +=
            Eigen::Map<const VectorX<Scalar>>(B_.valuePtr(), B_.nonZeros());
    }
    const SparseMatrix<Scalar>& matrix() const { return A_; }

    void load(const System& system, const State& state, Scalar tau, Scalar s,
              const Points<Scalar, Dim>& u, VectorX<Scalar>& b) {
        system.force(state, f_);
        system.for_each_tangent(state.x, [&](const SpringTangent<Scalar, Dim>& raw) {
            const auto t = raw.projected();
            const Eigen::Matrix<Scalar, Dim, 1> du = u.col(t.b) - u.col(t.a);
            const Eigen::Matrix<Scalar, Dim, 1> force =
                s * spring_product(t.d, t.axial, t.transverse, du);
            f_.col(t.a) += force;
            f_.col(t.b) -= force;
        });
        f_ *= tau;
        free().gather(f_, b);
    }
    void add_momentum(const System& system, const Points<Scalar, Dim>& p,
                      VectorX<Scalar>& b) const {
        for (Index j = 0; j < free().count(); ++j) {
            const Index i = free()[j];
            b.template segment<Dim>(Dim * j) += system.mass(i) * p.col(i);
        }
    }
    void add_to_velocity(const VectorX<Scalar>& dv, State& state) const {
        free().add(Scalar(1), dv, state.v);
    }
    const FreeParticles& free() const { return pattern_->free(); }

private:
    std::optional<TangentMatrix<Scalar, Dim>> pattern_;
    std::uint64_t topology_ = 0;
    SparseMatrix<Scalar> A_;  // M + τD + τ²K⁺
    SparseMatrix<Scalar> B_;  // its part M + hD, for Newton's method
    Points<Scalar, Dim> f_;   // Dim × n, N, then N·s
};

/// The particle of the first entry that is not finite, or −1.
template <class System, class Scalar>
Index first_not_finite(const StepEquation<System>& equation, const VectorX<Scalar>& b) {
    for (Index i = 0; i < b.size(); ++i) {
        if (!std::isfinite(b[i])) return equation.free()[i / System::Dim];
    }
    return -1;
}

/// What became of x ← A⁻¹ b by a solver. @param refused  what it is when the solver gave A up
template <class Solver, class Scalar>
Status solve_status(const Solver& solver, const VectorX<Scalar>& x, Status refused) {
    switch (solver.info()) {
        case Eigen::Success: return x.allFinite() ? Status::ok : Status::solver_failed;
        case Eigen::NoConvergence: return Status::not_converged;
        default: return refused;
    }
}

}  // namespace taut::integrator_detail
