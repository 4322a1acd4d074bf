// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the module newton.

#include <type_traits>

#include "../integrator/detail/factor_cache.hpp"
#include "../integrator/detail/step_loop.hpp"
#include "../conditions/implicit_euler.hpp"
#include "../network/free_particles.hpp"
#include "../newton/detail/step_objective.hpp"
#include "../solver/interleaved_llt.hpp"
#include "../solver/solver_concept.hpp"
#include "../proof/pencil_matrix.hpp"
#include "detail/limited_memory.hpp"

namespace taut {
/// Implicit Euler with the true, nonlinear spring forces, approached by iterations that share one
/// constant n × n matrix P = M + hL_c + h²L_k, factorised once for an h and a scene:
///
///     M(v⁺ − v) = h(f(x⁺) − D(x)v⁺),  x⁺ = x + u,  u = hv⁺;   u ← u − P⁻¹∇φ(u).
///
/// φ is the objective of the step (detail/step_objective.hpp). For Hooke's law an iteration is the
/// local/global one of T. Liu, A. Bargteil, J. O'Brien, L. Kavan, "Fast simulation of mass-spring
/// systems" (2013): the local step's k(dx − d), d = L·dx/l, is the spring's force. By [T3] and
/// [T28] P is no less than φ's second derivative at any pose, so with every law's `stiffness_bound`
/// each iteration lowers φ. A window accelerates it by L-BFGS about P (T. Liu, S. Bouaziz, L.
/// Kavan, "Quasi-Newton methods for real-time simulation of hyperelastic materials", 2017) with a
/// line search.
///
/// Dampers and Rayleigh damping are held at the start of the step, as in ImplicitEuler. Cost: one
/// factorisation for each new h (the last two are kept), mass, spring, damper or pin; a pass over
/// the springs and one solve an iteration.
/// @tparam Solver  for symmetric n × n matrices, solve() taking n × Dim with contiguous rows
template <class System, class Solver = InterleavedLLT<typename System::Scalar>>
class ProjectiveDynamics {
    static_assert(
        network_detail::is_spring_system_v<std::decay_t<System>>,
        "taut::ProjectiveDynamics: needs a SpringSystem; for matrices one linear solve is "
        "exact: taut::ImplicitEuler");

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr Method method = Method::implicit_euler;
    static constexpr int order = method::ImplicitEuler::order;
    static constexpr int Dim = System::Dim;

    static_assert((require_solver<Solver, Scalar>(), true));

    /// What a step may cost.
    struct Options {
        int iterations = 10;   ///< budget of a step, ≥ 1
        double tolerance = 0;  ///< stops the iterations when the residual is no larger; ≥ 0
        int window = 5;        ///< pairs that L-BFGS remembers; 0: plain projective dynamics
    };

    /// Keeps a reference: the system must outlive the stepper.
    explicit ProjectiveDynamics(const System& system) : ProjectiveDynamics(system, Options()) {}
    /// The same with options; those out of range go to fail().
    ProjectiveDynamics(const System& system, const Options& options);
    explicit ProjectiveDynamics(const System&&) = delete;
    ProjectiveDynamics(const System&&, const Options&) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before. The report's residual is ‖∇φ‖ after the last step, relative to that at
    /// its inertial start or to the momentum that the start gives. A spent budget is no failure: φ
    /// is no larger than at the inertial start, but for rounding.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1) {
        return loop_.run(*system_, state, h, count, [&](State& own) { return advance(own, h); });
    }
    /// Of the last step.
    int iterations() const { return iterations_; }
    /// Factorisations so far.
    std::int64_t factorizations() const { return factors_.count(); }

private:
    using Columns =
        Eigen::Matrix<Scalar, Eigen::Dynamic, Dim, Dim == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

    Status prepare(Scalar h);
    /// q ← P⁻¹ q on the free particles.
    void solve(Points<Scalar, Dim>& q);
    bool descend(Scalar& value);
    Report advance(State& state, Scalar h);

    const System* system_;
    Options options_;
    integrator_detail::StepLoop<State> loop_;
    integrator_detail::StepObjective<System> objective_;
    integrator_detail::LimitedMemory<Points<Scalar, Dim>> memory_;
    integrator_detail::FactorCache<Solver, Scalar> factors_;  // of P
    FreeParticles free_;                                      // of the rows of P
    std::uint64_t topology_ = 0;
    std::uint64_t revision_ = 0;
    bool prepared_ = false;
    int iterations_ = 0;
    Columns columns_;              // n × Dim, the free columns of what P is solved for
    Points<Scalar, Dim> u_, g_;    // iterate, m, and its gradient, kg·m
    Points<Scalar, Dim> du_;       // its next change
    Points<Scalar, Dim> u1_, g1_;  // a trial
};

template <class System, class Solver>
ProjectiveDynamics<System, Solver>::ProjectiveDynamics(const System& system, const Options& options)
    : system_(&system), options_(options), memory_(options.window > 0 ? options.window : 0) {
    if (options.iterations < 1) {
        fail("ProjectiveDynamics: iterations is ", options.iterations, "; it must be >= 1");
    }
    if (options.window < 0) {
        fail("ProjectiveDynamics: window is ", options.window, "; it must be >= 0");
    }
    require_non_negative("ProjectiveDynamics", "tolerance", options.tolerance);
}

template <class System, class Solver>
Status ProjectiveDynamics<System, Solver>::prepare(Scalar h) {
    if (!prepared_ || topology_ != system_->topology_revision()) {
        free_ = FreeParticles(*system_);
        factors_.forget_pattern();
    } else if (revision_ != system_->revision()) {
        factors_.forget_values();
    }
    prepared_ = true;
    topology_ = system_->topology_revision();
    revision_ = system_->revision();
    if (free_.count() == 0 || factors_.find(h)) return Status::ok;
    const double step = static_cast<double>(h);
    const SparseMatrix<Scalar> P =
        Pencil::any_pose(*system_)
            .assemble(matrices::M + step * matrices::D + step * step * matrices::K_plus)
            .template cast<Scalar>();
    return factors_.factorize(P, h) ? Status::ok : Status::not_positive_definite;
}

template <class System, class Solver>
void ProjectiveDynamics<System, Solver>::solve(Points<Scalar, Dim>& q) {
    // Rows are contiguous, so that the matrix is a vector over the free degrees of freedom, too.
    const auto flat = [&] { return Eigen::Map<VectorX<Scalar>>(columns_.data(), columns_.size()); };
    columns_.resize(free_.count(), Dim);
    auto right = flat();
    free_.gather(q, right);
    columns_ = factors_.solver().solve(columns_);
    free_.scatter(flat(), q);
}

/// One iteration on u_, g_ and φ; false when no shorter step lowers φ: what is left is rounding.
template <class System, class Solver>
bool ProjectiveDynamics<System, Solver>::descend(Scalar& value) {
    const auto by_p = [this](Points<Scalar, Dim>& q) { solve(q); };
    du_ = -g_;
    memory_.apply(du_, by_p);
    Scalar slope = du_.cwiseProduct(g_).sum();
    if (!(slope < 0)) {
        memory_.clear();
        du_ = -g_;
        solve(du_);
        slope = du_.cwiseProduct(g_).sum();
    }
    Scalar t = 1;
    for (int halving = 0; halving < 8; ++halving, t /= 2) {
        u1_ = u_ + t * du_;
        const Scalar next = objective_.evaluate(*system_, u1_, g1_);
        if (!objective_.not_above(next, value + Scalar(1e-4) * t * slope)) continue;
        u_.swap(u1_);
        g_.swap(g1_);
        value = next;
        if (options_.window > 0) {
            u1_ = u_ - u1_;
            g1_ = g_ - g1_;
            memory_.add(u1_, g1_);
        }
        return true;
    }
    return false;
}

template <class System, class Solver>
Report ProjectiveDynamics<System, Solver>::advance(State& state, Scalar h) {
    if (const Status status = prepare(h); status != Status::ok) return {status};
    objective_.begin(*system_, state, h);
    memory_.clear();
    u_ = objective_.inertial();
    Scalar value = objective_.evaluate(*system_, u_, g_);
    iterations_ = 0;
    while (iterations_ < options_.iterations &&
           objective_.force_residual(g_) > options_.tolerance) {
        ++iterations_;
        if (descend(value)) continue;
        if (memory_.empty()) break;
        memory_.clear();  // plain P descends wherever anything does
    }
    for (const Index i : free_) state.v.col(i) = u_.col(i) / h;
    state.x += u_;
    Report report;
    report.residual = objective_.force_residual(g_);
    return report;
}

}  // namespace taut
