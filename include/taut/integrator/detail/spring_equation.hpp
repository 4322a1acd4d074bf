// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "../../network/spring_system.hpp"
#include "../../network/tangent_matrix.hpp"
#include "../../solver/conjugate_gradient.hpp"
#include "step_equation.hpp"

namespace taut {

template <class Scalar, int Dim, class... Laws>
struct DefaultSolverOf<SpringSystem<Scalar, Dim, Laws...>, void> {
    using type = ConjugateGradient<Scalar, Dim>;
};

namespace integrator_detail {

/// For springs: assembled in place at every pose; the pattern changes with the topology alone.
template <class Scalar, int Dim, class... Laws>
class StepEquation<SpringSystem<Scalar, Dim, Laws...>, void> {
public:
    using System = SpringSystem<Scalar, Dim, Laws...>;
    using State = typename System::State;
    static constexpr bool constant = false;
    static constexpr bool symmetric = true;

    bool update_pattern(const System& system) {
        if (pattern_ && topology_ == system.topology_revision()) return false;
        pattern_.emplace(system);
        A_ = pattern_->zero();
        topology_ = system.topology_revision();
        return true;
    }
    void update_values(const System& system, const State& state, Scalar tau) {
        const double step = static_cast<double>(tau);
        pattern_->assemble(system, state.x,
                           matrices::M + step * matrices::D + step * step * matrices::K_plus, A_);
    }
    const SparseMatrix<Scalar>& matrix() const { return A_; }
    /// For a module that fills it anew, by tangent().
    SparseMatrix<Scalar>& matrix() { return A_; }
    const TangentMatrix<Scalar, Dim>& tangent() const { return *pattern_; }

    void load(const System& system, const State& state, Scalar tau, Scalar s,
              const Points<Scalar, Dim>& u, VectorX<Scalar>& b) {
        system.force(state, f_);
        system.for_each_tangent(state.x, [&](const SpringTangent<Scalar, Dim>& spring) {
            TangentMatrix<Scalar, Dim>::add_product(spring, s, u, f_);
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
    Points<Scalar, Dim> f_;   // Dim × n, N, then N·s
};

}  // namespace integrator_detail
}  // namespace taut
