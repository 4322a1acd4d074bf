// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/imex/imex.hpp>

#include "../support/energy_steps.hpp"

// The step of ImexEuler, its inertia and its condition, from the theory's formulas in long double,
// by dense matrices.

namespace taut_test {

/// n × n over all particles, pins included.
struct ImexMatrices {
    RealMatrix A;     ///< M + Σ s(h₀²k + ½h₀c)L_e, kg
    RealMatrix L, D;  ///< L_k, N/m, and what bounds the damping, N·s/m
    std::vector<Index> free;

    RealMatrix free_part(const RealMatrix& of) const { return of(free, free); }
    /// Whether A ⪰ h²L_k + ½hD over the free particles.
    bool holds(Real h) const {
        const RealMatrix rest = free_part(A - h * h * L - h / 2 * D);
        return rest.rows() == 0 || eigenvalues(rest)[0] >= 0;
    }
    /// The largest h of which it does, found between 0 and `most`.
    Real edge(Real most) const {
        Real low = 0, high = most;
        for (int i = 0; i < 60; ++i) (holds((low + high) / 2) ? low : high) = (low + high) / 2;
        return low;
    }
};

/// @param share  share(s) of spring s
template <class System, class ShareOf>
ImexMatrices imex_matrices(const System& system, double step, const ShareOf& share) {
    const Index n = system.size();
    const RealMatrix zero = RealMatrix::Zero(n, n);
    ImexMatrices matrices{zero, zero, zero, {}};
    const auto alpha = static_cast<Real>(system.rayleigh().stiffness_proportional);
    const auto drag = static_cast<Real>(system.rayleigh().mass_proportional);
    const Real h = static_cast<Real>(step) *
                   (1 + taut::stability_detail::step_rounding<typename System::Scalar>);
    for (Index i = 0; i < n; ++i) {
        matrices.A(i, i) = static_cast<Real>(system.mass(i));
        matrices.D(i, i) = drag * static_cast<Real>(system.mass(i));
        if (!system.is_pinned(i)) matrices.free.push_back(i);
    }
    Index index = 0;
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t e = 0; e < set.a.size(); ++e) {
            const Real k = Law::stiffness_bound(set.parameters[e].template cast<Real>(),
                                                static_cast<Real>(set.rest_length[e]));
            const Real c = static_cast<Real>(set.damping_of(e)) + alpha * k;
            const auto add = [a = set.a[e], b = set.b[e]](RealMatrix& to, Real weight) {
                to(a, a) += weight;
                to(b, b) += weight;
                to(a, b) -= weight;
                to(b, a) -= weight;
            };
            add(matrices.L, k);
            add(matrices.D, c);
            add(matrices.A, static_cast<Real>(share(index++)) * (h * h * k + h / 2 * c));
        }
    });
    return matrices;
}

/// ½vᵀ(A − M)v, J.
template <class System>
Real added_energy(const System& system, const ImexMatrices& matrices,
                  const typename System::State& state) {
    RealMatrix added = matrices.A;
    for (Index i = 0; i < system.size(); ++i) added(i, i) -= static_cast<Real>(system.mass(i));
    const RealMatrix v = state.v(Eigen::all, matrices.free).transpose().template cast<Real>();
    return (v.transpose() * matrices.free_part(added) * v).trace() / 2;
}

/// One step as the theory writes it.
template <class System>
struct DirectImex {
    static constexpr int Dim = System::Dim;
    using Points = Eigen::Matrix<Real, Dim, Eigen::Dynamic>;

    Points x, v;     ///< after the step
    Points springs;  ///< forces of springs and their damping on all particles, N
    Real size = 0;   ///< what rounding errors of H are relative to, J
    Real moved = 0;  ///< ½ΔᵀAΔ, J

    /// @param F  outside forces, Dim × n, N
    DirectImex(const System& system, const ImexMatrices& matrices,
               const typename System::State& state, Real h, const Points& F)
        : x(state.x.template cast<Real>()), v(state.v.template cast<Real>()) {
        const StepAhead<System> ahead(system, state, h, F);
        springs = ahead.springs;
        const auto& free = matrices.free;
        const auto count = static_cast<Index>(free.size());
        const auto d0 = static_cast<Real>(system.rayleigh().mass_proportional);
        const auto gravity = system.gravity().template cast<Real>().eval();
        RealMatrix f(count, Dim), old(count, Dim);
        for (Index j = 0; j < count; ++j) {
            const auto m = static_cast<Real>(system.mass(free[j]));
            old.row(j) = v.col(free[j]).transpose();
            f.row(j) = (springs.col(free[j]) + F.col(free[j]) + m * (gravity - d0 * v.col(free[j])))
                           .transpose();
        }
        const RealMatrix A = matrices.free_part(matrices.A);
        const RealMatrix change = count > 0 ? RealMatrix(h * solve(A, f)) : f;
        const RealMatrix next = old + change;
        for (Index j = 0; j < count; ++j) v.col(free[j]) = next.row(j).transpose();
        moved = (change.transpose() * A * change).trace() / 2;
        const RealMatrix speed = old.cwiseAbs() + next.cwiseAbs();
        size = 2 * (speed.transpose() * A.cwiseAbs() * speed).trace();
        for (Index i = 0; i < system.size(); ++i) {
            const Real speeds = state.v.col(i).template cast<Real>().norm() + v.col(i).norm();
            size += ahead.noise[i] * (x.col(i).norm() + h * speeds);
        }
        x += h * v;
    }
};

/// Takes a step and keeps the books of H = ½vᵀAv + U, with the work of forces and pins by the
/// forces written out above.
template <class Stepper, class System>
Books book_imex(Stepper& stepper, const System& system, const ImexMatrices& matrices,
                typename System::State& state, typename System::Scalar h,
                const typename DirectImex<System>::Points& F) {
    constexpr Real epsilon = std::numeric_limits<typename System::Scalar>::epsilon();
    const auto time = static_cast<Real>(h);
    const DirectImex<System> exact(system, matrices, state, time, F);
    const Real start = total_energy(system, state) + added_energy(system, matrices, state);
    Books books;
    if (!stepper.step(state, h)) {
        books.gain = std::numeric_limits<Real>::infinity();
        return books;
    }
    Real work = 0;
    for (Index i = 0; i < system.size(); ++i) {
        const auto v = state.v.col(i).template cast<Real>().eval();
        work += time * (system.is_pinned(i) ? -v.dot(exact.springs.col(i)) : v.dot(F.col(i)));
    }
    books.gain = total_energy(system, state) + added_energy(system, matrices, state) - start - work;
    books.slack = 8 * epsilon * exact.size;
    books.kinetic = exact.moved;
    return books;
}

}  // namespace taut_test
