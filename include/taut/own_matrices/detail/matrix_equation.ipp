// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// How implicit steps take systems of matrices.

namespace taut {
namespace integrator_detail {

template <class System>
using OfMatrices =
    std::enable_if_t<std::is_base_of_v<GeneralLinearSystem<typename System::Scalar>, System>>;

}  // namespace integrator_detail

/// Of constant matrices the factors are kept.
template <class System>
struct DefaultSolverOf<System, integrator_detail::OfMatrices<System>> {
    using type =
        Eigen::SimplicialLLT<SparseMatrix<typename System::Scalar>, Eigen::Lower, BlockOrdering<>>;
};

namespace integrator_detail {

/// For matrices: constant, so the step matrix changes with τ alone.
template <class System>
class StepEquation<System, OfMatrices<System>> {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr bool constant = true;
    static constexpr bool symmetric = std::is_base_of_v<LinearSystem<Scalar>, System>;

    /// @returns whether the sparsity pattern is new
    bool update_pattern(const System& system) {
        if (A_.rows() == system.size() && revision_ == system.revision()) return false;
        free_ = FreeParticles::all(system.size());
        revision_ = system.revision();
        assemble(system, 1);
        tau_ = 0;
        return true;
    }
    void update_values(const System& system, const State&, Scalar tau) {
        if (tau != tau_) assemble(system, tau);
        tau_ = tau;
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

}  // namespace integrator_detail
}  // namespace taut
