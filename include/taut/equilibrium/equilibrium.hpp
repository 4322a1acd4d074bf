// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/detail/fits.hpp"
#include "../core/status.hpp"
#include "../network/spring_system.hpp"
#include "../network/tangent_matrix.hpp"

namespace taut {

/// When static_equilibrium stops.
struct EquilibriumOptions {
    int max_iterations = 500;
    /// On the norm of the free forces, relative to the first ones or the weight.
    /// What the rounding of x leaves passes in any case.
    double tolerance = 1e-8;
};

namespace solver_detail {

/// Newton's method on the free particles: (K + σM) Δx = f with a line search on the energy, with K⁺
/// for K far from the solution or where K is indefinite. σ holds mechanisms back, and shrinks with
/// every full step.
template <class System>
class EquilibriumSearch {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;

    EquilibriumSearch(const System& system, const State& start);

    /// Whether what is left is below `tolerance`, or is the rounding of x and no step lowers it.
    bool converged(double tolerance) const {
        const bool stuck = failures_ >= 4 && residual_.norm() <= rounding_;
        const double force = relative_force();
        return (detail::is_finite(force) && force <= tolerance) || stuck;
    }
    /// ‖free forces‖ relative to the first ones, or to the weight.
    double relative_force() const {
        return scale_ > 0 ? static_cast<double>(residual_.norm() / scale_) : 0;
    }
    Status iterate();
    bool at_saddle();
    const State& state() const { return state_; }

private:
    void update_forces();
    bool line_search(const VectorX<Scalar>& dx);

    const System& system_;
    TangentMatrix<Scalar, Dim> tangent_;
    SparseMatrix<Scalar> A_;  // K⁺ + σM
    Eigen::SimplicialLLT<SparseMatrix<Scalar>> llt_;
    State state_;
    State trial_;
    Points<Scalar, Dim> f_;         // Dim × n, N
    Points<Scalar, Dim> external_;  // its part without an energy, N
    VectorX<Scalar> residual_;      // free forces, N
    Scalar scale_ = 0;              // what forces are relative to, N
    Scalar stiffness_ = 0;          // √Σ bound² over both ends of all springs, N/m
    Scalar rounding_ = 0;           // what the rounding of x makes of the forces, N
    int failures_ = 0;              // iterations in a row without a step
    Scalar sigma_ = 0;              // 1/s²
};

template <class System>
EquilibriumSearch<System>::EquilibriumSearch(const System& system, const State& start)
    : system_(system), tangent_(system), A_(tangent_.zero()), state_(start), trial_(start) {
    llt_.analyzePattern(A_);
    state_.v.setZero();
    trial_.v.setZero();
    Scalar mass = 0;
    for (const Index i : tangent_.free()) mass += system.mass(i);
    system.for_each_tangent(state_.x, [&](const SpringTangent<Scalar, Dim>& t) {
        stiffness_ += 2 * t.bound * t.bound;
    });
    stiffness_ = std::sqrt(stiffness_);
    update_forces();
    scale_ = (std::max)(mass * system.gravity().norm(), residual_.norm());
    // The first step moves a mechanism by about a hundredth of the scene.
    const Scalar extent = (state_.x.rowwise().maxCoeff() - state_.x.rowwise().minCoeff()).norm();
    const Scalar step = extent > 0 ? extent / 100 : Scalar(1) / 100;
    sigma_ = scale_ / (mass * step);
}

template <class System>
void EquilibriumSearch<System>::update_forces() {
    system_.force(state_, f_);
    system_.external_force(state_, external_);
    rounding_ =
        4 * std::numeric_limits<Scalar>::epsilon() * stiffness_ * state_.x.cwiseAbs().maxCoeff();
    tangent_.free().gather(f_, residual_);
}

/// Halves the step until the energy falls or the forces do; moves state_ if one of them does.
template <class System>
bool EquilibriumSearch<System>::line_search(const VectorX<Scalar>& dx) {
    const auto& free = tangent_.free();
    const Scalar energy = system_.potential_energy(state_);
    const Scalar descent = residual_.dot(dx);
    Points<Scalar, Dim> f;
    Scalar t = 1;
    for (int halving = 0; halving < 24; ++halving, t /= 2) {
        Scalar work = 0;  // of the external force, taken as constant
        Scalar force = 0;
        trial_.x = state_.x;
        free.add(t, dx, trial_.x);
        for (Index j = 0; j < free.count(); ++j) {
            work += t * external_.col(free[j]).dot(dx.template segment<Dim>(Dim * j));
        }
        system_.force(trial_, f);
        for (const Index i : free) force += f.col(i).squaredNorm();
        const bool lower =
            system_.potential_energy(trial_) - work < energy - Scalar(1e-4) * t * descent;
        // Close to the solution differences of energy drown in rounding; the forces do not.
        if (!detail::is_finite(force)) continue;
        if (lower || force < Scalar(0.25) * residual_.squaredNorm()) {
            state_.x = trial_.x;
            sigma_ *= halving == 0 ? Scalar(0.25) : Scalar(1);
            return true;
        }
    }
    return false;
}

template <class System>
Status EquilibriumSearch<System>::iterate() {
    const auto factorize = [&](bool project) {
        tangent_.assemble(
            system_, state_.x,
            static_cast<double>(sigma_) * matrices::M + (project ? matrices::K_plus : matrices::K),
            A_);
        llt_.factorize(A_);
        return llt_.info() == Eigen::Success;
    };
    // Close to a stable pose the true K is definite and converges quadratically, K⁺ only linearly.
    if (relative_force() > 0.05 || !factorize(false)) factorize(true);
    const VectorX<Scalar> dx =
        llt_.info() == Eigen::Success ? VectorX<Scalar>(llt_.solve(residual_)) : VectorX<Scalar>();
    if (dx.size() > 0 && detail::all_finite(dx) && line_search(dx)) {
        update_forces();
        failures_ = 0;
    } else {
        ++failures_;
        sigma_ = 16 * (std::max)(sigma_, (std::numeric_limits<Scalar>::min)() * 1000);
        if (!detail::is_finite(sigma_)) return Status::not_converged;
    }
    return Status::ok;
}

/// Whether K at this pose is negative in some direction, by more than what rounding and the
/// tolerance leave in it. Mechanisms, in whose directions K is 0, are none. K is factorised with √ε
/// of each spring's stiffness more at both of its ends: then that the factor exists proves K no
/// more negative than that, and its absence that K + this is indefinite, or within rounding of it.
template <class System>
bool EquilibriumSearch<System>::at_saddle() {
    const auto& free = tangent_.free();
    VectorX<Scalar> shift = VectorX<Scalar>::Zero(free.count());
    const auto add = [&](Index particle, Scalar stiffness) {
        if (free.place(particle) >= 0) shift[free.place(particle)] += stiffness;
    };
    system_.for_each_tangent(state_.x, [&](const SpringTangent<Scalar, Dim>& t) {
        const Scalar most = (std::max)({t.bound, (std::abs)(t.axial), (std::abs)(t.transverse)});
        add(t.a, most);
        add(t.b, most);
    });
    tangent_.assemble(system_, state_.x, matrices::K, A_);
    const Scalar share = std::sqrt(std::numeric_limits<Scalar>::epsilon());
    for (Index i = 0; i < A_.cols(); ++i) {
        const Scalar own = share * shift[i / Dim];
        A_.coeffRef(i, i) += own > 0 ? own : Scalar(1);  // no spring: any number keeps it definite
    }
    llt_.factorize(A_);
    return llt_.info() != Eigen::Success;
}

}  // namespace solver_detail

/// Moves the free particles of `state` to a pose where no force is left: Newton's method and
/// a line search on the potential energy. Velocities become 0. An external force is taken as
/// constant within a line search, and where it is asked whether the pose is stable.
/// @returns not_converged after max_iterations (what falls for ever has no equilibrium), or saddle
///          where the forces balance as on a column that is about to buckle: disturb the pose and
///          ask again. Both leave the state as it was; residual is the relative force left
template <class Scalar, int Dim, class... Laws>
Report static_equilibrium(const SpringSystem<Scalar, Dim, Laws...>& system,
                          State<Scalar, Dim>& state, const EquilibriumOptions& options = {}) {
    if (!detail::fits(state, system.size())) return {Status::invalid_state};
    if (!state.finite()) return {Status::invalid_state, 0, 0, state.first_not_finite()};
    if (system.pinned_count() == system.size()) {
        state.v.setZero();
        return {};
    }
    solver_detail::EquilibriumSearch<SpringSystem<Scalar, Dim, Laws...>> search(system, state);
    Report report;
    report.residual = search.relative_force();
    while (report && !search.converged(options.tolerance)) {
        if (report.iterations >= options.max_iterations || !detail::is_finite(report.residual)) {
            report.status =
                detail::is_finite(report.residual) ? Status::not_converged : Status::diverged;
            break;
        }
        report.status = search.iterate();
        ++report.iterations;
        report.residual = search.relative_force();
    }
    if (report && search.at_saddle()) report.status = Status::saddle;
    if (report) state = search.state();
    return report;
}

}  // namespace taut
