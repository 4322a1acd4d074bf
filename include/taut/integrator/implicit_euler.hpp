// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <type_traits>

#include "../method/implicit_euler.hpp"
#include "../constraints/particle_constraints.hpp"
#include "../solver/block_ordering.hpp"
#include "../constraints/detail/constraint_projection.hpp"
#include "detail/factor_cache.hpp"
#include "../newton/detail/newton.hpp"
#include "detail/step_equation.hpp"
#include "detail/step_loop.hpp"

namespace taut {

template <class Scalar>
class GeneralLinearSystem;

namespace integrator_detail {

template <class Solver, class Vector>
using solve_with_guess_of = decltype(std::declval<const Solver&>().solveWithGuess(
    std::declval<const Vector&>(), std::declval<const Vector&>()));

/// In place of Newton's method where one linear solve is exact.
struct NoNewton {};

}  // namespace integrator_detail

/// Implicit Euler by one linearised solve a step [T6]:
///
///     (M + hD + h²K) v⁺ = M v + h(f − Kx),  x⁺ = x + h v⁺.
///
/// On a SpringSystem K⁺ stands for K, so the matrix is positive definite at every pose and every h
/// [T27]. The pattern is analysed once for a topology. Springs are factorised at every step;
/// constant matrices once for each h, and the factors of the last two h are kept.
///
/// Options ask for the nonlinear step instead, M(v⁺ − v) = h(f(x⁺) − D(x)v⁺), by Newton's method
/// from that solve with a line search on the objective of the step: where the energy is convex,
/// [T24] holds, as Options::tolerance states it.
///
/// constraints() hold particles in planes, on lines, at points or to velocities, exactly in a
/// direct solve, by filtering in conjugate gradients [T31], as in D. Baraff, A. Witkin, "Large
/// steps in cloth simulation", SIGGRAPH 1998.
/// @tparam Solver  Eigen's sparse solver interface (analyzePattern, factorize, solve, info). Not
///                 SimplicialLDLT: it calls an indefinite matrix a success. One with Eigen's
///                 solveWithGuess starts from the last Δv, so that its steps depend on the last
///                 ones within its tolerance.
template <class System, class Solver = Eigen::SimplicialLLT<SparseMatrix<typename System::Scalar>,
                                                            Eigen::Lower, BlockOrdering<>>>
class ImplicitEuler {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    using Constraints = ParticleConstraints<Scalar, Dim>;
    static constexpr Method method = Method::implicit_euler;
    static constexpr int order = method::ImplicitEuler::order;
    static constexpr bool symmetric =
        !std::is_same_v<std::decay_t<System>, GeneralLinearSystem<Scalar>>;

    static_assert((require_system<System>(), true));
    static_assert((require_solver<Solver, Scalar>(), true));
    static_assert(symmetric || !is_symmetric_solver_v<Solver>,
                  "taut::ImplicitEuler: a GeneralLinearSystem needs an unsymmetric solver "
                  "(taut::Umfpack, Eigen::SparseLU); a symmetric one would read one triangle only");

    /// The linearised step, or the nonlinear one.
    struct Options {
        /// Linear solves of a step at most. 1: the linearised step; more: the nonlinear one, and
        /// not_converged if they do not reach the tolerance. Without effect on matrices.
        int newton_iterations = 1;
        /// On the residual r of the nonlinear equation, > 0, in three quotients: of each particle
        /// ‖r_i‖ over the sizes of the momenta and impulses that meet in it, at the step's end or
        /// at the inertial move; |v⁺ᵀr| over the stake T + V + |W|; where energy_never_rises_v what
        /// the step gains over the same stake. Rounding alone may lift them above it.
        ///
        /// The promise of a step that is ok, with the kinetic energy T and the springs' V before
        /// it, T⁺ and V⁺ after it, the work W of gravity and external force in it, J, where
        /// energy_never_rises_v and what is pinned or constrained is at rest [T24]:
        ///
        ///     T⁺ + V⁺ − T − V − W ≤ tolerance·(T + V + |W|) + R(x) + R(x⁺)
        ///                                            + 64ε(T + V + |W| + T⁺ + V⁺)
        ///     R(x) = Σ (tension·ρ_s + ½·stiffness_bound·ρ_s²) + Σ m_i‖gravity‖ρ_i,
        ///
        /// over springs s of ends a and b and free particles i, ε that of Scalar, ρ_i = 4ε‖x_i‖,
        /// ρ_s = ρ_a + ρ_b: R is what the rounding of positions can do. A step that cannot be
        /// solved so far, of a stiffness beyond the solver's digits say, is refused.
        double tolerance = 1e-6;
    };

    /// Keeps a reference: the system must outlive the stepper.
    explicit ImplicitEuler(const System& system) : ImplicitEuler(system, Options()) {}
    /// The same with options; those out of range go to fail().
    ImplicitEuler(const System& system, const Options& options);
    explicit ImplicitEuler(const System&&) = delete;
    ImplicitEuler(const System&&, const Options&) = delete;

    /// Change them between steps at will. Those of pinned particles have no effect.
    Constraints& constraints() { return constraints_; }
    /// Of the constraints on their particles in the last step, N, Dim × n, zero elsewhere: for
    /// friction, or to decide on a release. Empty (0 columns) if that had none, or failed.
    const Points<Scalar, Dim>& constraint_forces() const { return forces_; }

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before; a constraint on a particle that the system does not have is
    /// invalid_state, at that particle. The report's residual is that of the last linear solve,
    /// relative to its right-hand side; with newton_iterations > 1 that of the nonlinear equation,
    /// as Options::tolerance has it.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);
    /// change(solver) for every solver that the stepper keeps: to set a tolerance, a cap of
    /// iterations.
    template <class Change>
    void configure(Change&& change) {
        factors_.configure(change);
    }
    /// The solver used last.
    const Solver& solver() const { return factors_.solver(); }
    /// Factorisations so far.
    std::int64_t factorizations() const { return factors_.count(); }

private:
    static constexpr Status refused =
        symmetric ? Status::not_positive_definite : Status::solver_failed;
    static constexpr bool springs = model_detail::is_spring_system_v<std::decay_t<System>>;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Equation = integrator_detail::StepEquation<System>;
    using Newton =
        std::conditional_t<springs, integrator_detail::Newton<System>, integrator_detail::NoNewton>;

    Report advance(State& state, Scalar h);
    Report solve_linearised(const State& state, Scalar h);
    Status factorize(Scalar h);
    Status solve(const VectorX<Scalar>& b, VectorX<Scalar>& x);
    template <class Force>
    void set_forces(Force&& force);

    const System* system_;
    Options options_;
    Constraints constraints_;
    integrator_detail::StepLoop<State> loop_;
    Equation equation_;
    integrator_detail::ConstraintProjection<Scalar, Dim> projection_;
    integrator_detail::FactorCache<Solver, Scalar> factors_;
    bool projected_ = false;  // whether factors_ are those of the projection
    Newton newton_;
    VectorX<Scalar> b_;           // N, N·s
    VectorX<Scalar> reduced_;     // b_ as the constraints leave it
    VectorX<Scalar> dv_;          // N, m/s
    Points<Scalar, Dim> forces_;  // of the constraints, Dim × n, N
};

template <class System, class Solver>
template <class AnyState>
Report ImplicitEuler<System, Solver>::step(AnyState& state, Scalar h, Index count) {
    if (!constraints_.held().empty()) {
        const Index last = constraints_.held().rbegin()->first;
        if (last >= system_->size()) return {Status::invalid_state, 0, 0, last};
    }
    return loop_.run(*system_, state, h, count, [&](State& own) { return advance(own, h); });
}

template <class System, class Solver>
ImplicitEuler<System, Solver>::ImplicitEuler(const System& system, const Options& options)
    : system_(&system), options_(options) {
    if (options.newton_iterations < 1) {
        fail("ImplicitEuler: newton_iterations is ", options.newton_iterations,
             "; it must be >= 1");
    }
    require_positive("ImplicitEuler", "tolerance", options.tolerance);
}

template <class System, class Solver>
Status ImplicitEuler<System, Solver>::factorize(Scalar h) {
    if (!Equation::constant || projected_ || projection_.active()) factors_.forget_values();
    projected_ = projection_.active();
    if (factors_.find(h)) return Status::ok;
    const auto& A = equation_.matrix();
    if (factors_.factorize(projected_ ? projection_.matrix(A) : A, h)) return Status::ok;
    return refused;
}

/// x ← A⁻¹ b, from x as it is where the solver can make use of it.
template <class System, class Solver>
Status ImplicitEuler<System, Solver>::solve(const VectorX<Scalar>& b, VectorX<Scalar>& x) {
    if constexpr (detail::is_detected_v<integrator_detail::solve_with_guess_of, Solver,
                                        VectorX<Scalar>>) {
        x = factors_.solver().solveWithGuess(b, x);
    } else {
        x = factors_.solver().solve(b);
    }
    return integrator_detail::solve_status(factors_.solver(), x, refused);
}

/// dv_ ← Δv of the linearised step.
template <class System, class Solver>
Report ImplicitEuler<System, Solver>::solve_linearised(const State& state, Scalar h) {
    const auto& A = equation_.matrix();
    if (equation_.update_pattern(*system_)) {
        factors_.forget_pattern();
        projection_.update_pattern(equation_.free());
        dv_.setZero(A.rows());
    }
    projection_.begin(constraints_, state.v);
    forces_.resize(Eigen::NoChange, 0);
    if (dv_.size() == 0) return {};  // nothing free; not every solver takes 0 × 0
    equation_.update_values(*system_, state, h);
    equation_.load(*system_, state, h, h, state.v, b_);
    Report report{factorize(h)};
    if (!report) return report;
    if (const Index where = integrator_detail::first_not_finite(equation_, b_); where >= 0) {
        return {Status::solver_failed, 0, 0, where};
    }
    if (projected_) {
        projection_.reduce(A, b_, reduced_);
        projection_.project(dv_);
    }
    const VectorX<Scalar>& right = projected_ ? reduced_ : b_;
    const Scalar norm = right.norm();
    report.solves = 1;
    report.status = solve(right, dv_);
    if (!report) {
        report.where = integrator_detail::first_not_finite(equation_, dv_);
        return report;
    }
    if (projected_) projection_.complete(dv_);
    b_.noalias() -= A * dv_;
    if (projected_) {
        // What the springs leave open along the constraints is for these to give.
        set_forces([&](Index particle) -> Vector {
            const Index j = projection_.block(particle);
            if (j < 0) return Vector::Zero();
            return -b_.template segment<Dim>(Dim * j) / h;
        });
        projection_.project(b_);
    }
    report.residual = norm > 0 ? static_cast<double>(b_.norm() / norm) : 0;
    return report;
}

/// @param force  of all that is missing on a particle, N: force(particle)
template <class System, class Solver>
template <class Force>
void ImplicitEuler<System, Solver>::set_forces(Force&& force) {
    forces_.setZero(Dim, system_->size());
    for (const auto& [particle, held] : constraints_.held()) {
        forces_.col(particle) = held.directions * (held.directions.transpose() * force(particle));
    }
}

template <class System, class Solver>
Report ImplicitEuler<System, Solver>::advance(State& state, Scalar h) {
    Report report = solve_linearised(state, h);
    if (!report) {
        dv_.setZero();  // no start for the next solve
        return report;
    }
    if constexpr (springs) {
        if (options_.newton_iterations > 1 && dv_.size() > 0) {
            report = newton_.step(
                *system_, state, dv_, h, options_, equation_,
                [&](const VectorX<Scalar>& b, VectorX<Scalar>& dx) {
                    const Status status = factorize(h);
                    return status == Status::ok ? solve(b, dx) : status;
                },
                [&](Points<Scalar, Dim>& g) { constraints_.filter(g); });
            forces_.resize(Eigen::NoChange, 0);
            if (projected_ && report) {
                const auto& r = newton_.whole_gradient(*system_);
                set_forces([&](Index particle) -> Vector { return r.col(particle) / (h * h); });
            }
            return report;
        }
    }
    equation_.add_to_velocity(dv_, state);
    state.x += h * state.v;
    return report;
}

}  // namespace taut
