// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the modules contact, mass_scaling, tight.

#include <cmath>
#include <cstdint>
#include <utility>

#include "../method/graph_inertia.hpp"
#include "../solver/interleaved_llt.hpp"
#include "graph_shares.hpp"
#include "../integrator/detail/explicit_steps.hpp"
#include "detail/graph_matrix.hpp"
#include "../integrator/detail/last_state.hpp"
#include "graph_inertia_options.hpp"

namespace taut {

/// Symplectic Euler with more inertia, spring by spring [T33]: each spring has a share s of
/// implicitness, and the masses grow by a constant matrix,
///
///     M̃ = M + (1/θ) Σ s(h c/2 + h² k/4) L_e,   M̃(v⁺ − v) = h f(x, v),   x⁺ = x + h v⁺ ,
///
/// L_e being the graph Laplacian of one spring, k its stiffness bound, c its damping bound. The
/// shares make h safe at every pose and add little inertia: a stiff hem is implicit, the cloth
/// beside it explicit. One n × n factor of the particles that such springs touch serves all
/// coordinates and all steps. Linear momentum is kept. What it costs in accuracy: implicit springs
/// resist rotation and folding as if they were heavier.
///
/// `dissipation` δ adds implicit damping D_i = (δ/θ) Σ s ½hk L_e, taken at the mean of v and v⁺. At
/// δ = 0 there is no numerical damping; at δ = 1 all springs are implicit, and at the step that the
/// factor was made for the energy cannot rise, that of the dampers' inertia counted [T35].
///
/// A factor made for a step serves every shorter one, with the inertia of the longer: prepare(h)
/// gives the shorter step its own. It is made anew by itself when the step grows and when the
/// system's revision() moves on.
/// @tparam Solver  for symmetric n × n matrices, solve() taking n × Dim with contiguous rows
template <class System,
          class Solver = InterleavedLLT<typename System::Scalar, Eigen::NaturalOrdering<int>>>
class GraphInertia {
    static_assert(model_detail::is_spring_system_v<std::decay_t<System>>,
                  "taut::GraphInertia: needs a SpringSystem; matrices have no springs to share");

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = GraphInertiaOptions;
    static constexpr Method method = Method::graph_inertia;
    static constexpr int order = method::GraphInertia::order;

    static_assert((require_solver<Solver, Scalar>(), true));

    /// Keeps a reference: the system must outlive the stepper.
    explicit GraphInertia(const System& system, const Options& options = {})
        : system_(&system), options_(options), steps_(ExplicitOptions{options.threads, {}}) {
        options.require_valid();
    }
    explicit GraphInertia(const System&&, const Options& = {}) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before; the report says so where h is too large for shares, for the masses or
    /// for the memory.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);

    /// Makes the stepper ready for steps of h, s, as step() does by itself: with the factor that it
    /// has if that serves.
    Report renew(Scalar h);
    /// The same for the step of the shares in force, after an edit; nothing before the first step.
    Report renew() {
        return shares_.step > 0 ? renew(static_cast<Scalar>(shares_.step)) : Report{};
    }
    /// The same with a factor of its own for h, even where that of a larger step would serve: less
    /// inertia.
    Report prepare(Scalar h);
    /// The shares in force; of step 0 before the first step.
    const GraphShares& shares() const { return shares_; }
    /// The system of the constructor.
    const System& system() const { return *system_; }
    /// What the stepper was made with.
    const Options& options() const { return options_; }
    /// Particles in the factor.
    Index touched() const { return matrix_.size(); }
    /// Factorisations so far.
    std::int64_t factorizations() const { return factorizations_; }
    /// How often shares were chosen so far, with a factor or without: the inertia is another then.
    std::int64_t renewals() const { return renewals_; }
    /// ½vᵀ(M̃ − M)v over the free particles, J: what the added inertia holds; 0 until the next step
    /// where the system was edited.
    double added_kinetic(const State& state) const {
        return is_current() ? matrix_.added_kinetic(state.v) : 0;
    }
    /// A_ii of particle i, kg, which response_to() shares out among its neighbours; its mass before
    /// the first step.
    Scalar inertia(Index i) const { return matrix_.diagonal(i, system_->mass(i)); }
    /// √θ: within this share of ½vᵀM̃v + U the energy oscillates that the steps keep, as that of
    /// symplectic Euler does at this share of its limit [T36].
    double energy_share() const { return std::sqrt(options_.margin); }
    /// The work that pins did in the last successful call through added inertia and dissipation, J.
    double pin_work() const { return pin_work_; }
    /// The pins as the last call left them, and how to go on from there: a step sees by them that
    /// pins have changed their velocity since. For who takes a state back.
    const State& pins_seen() const { return last_.state(); }
    /// @param seen  what pins_seen() was then
    void see_pins(const State& seen) { last_.keep(*system_, seen); }
    /// The change of velocity, m/s, that impulses make, N·s, Dim × n; none of pins. What changes
    /// velocities from outside, such as contacts, must go through it: a particle that is changed
    /// alone gains what its neighbours should have lost.
    Points<Scalar, System::Dim> response_to(const Points<Scalar, System::Dim>& impulse);

private:
    using Matrix = integrator_detail::GraphMatrix<System>;
    using Vector = typename System::Vector;

    /// Whether shares and factor are of the system as it is.
    bool is_current() const { return prepared_ && shares_.revision == system_->revision(); }
    Report fail_to_prepare(const Report& why) {
        matrix_ = Matrix();
        last_.forget();
        return why;
    }
    /// a ← M̃⁻¹M a and what pins and dissipation add, of the touched particles.
    template <class Accelerations, class Velocities>
    void correct(const Accelerations& a, const Velocities& v, Scalar h);
    template <class AnyState>
    bool pins_jump(const AnyState& state, Scalar h) const;

    const System* system_;
    Options options_;
    GraphShares shares_;
    Matrix matrix_;
    Solver solver_;
    typename Matrix::Rows rows_, solution_, jump_;
    integrator_detail::ExplicitSteps<System> steps_;
    std::int64_t factorizations_ = 0;
    std::int64_t renewals_ = 0;
    bool prepared_ = false;
    // Where springs with a share end at pins: the last state, to see pins change their velocity.
    integrator_detail::LastState<State> last_;
    bool pins_jump_ = false;  // before the next step
    double pin_work_ = 0;     // J
};

template <class System, class Solver>
Report GraphInertia<System, Solver>::renew(Scalar h) {
    const bool serves = is_current() && static_cast<double>(h) <= shares_.step;
    return serves ? Report{} : prepare(h);
}

template <class System, class Solver>
Report GraphInertia<System, Solver>::prepare(Scalar h) {
    if (!(h > 0) || !std::isfinite(h)) return {Status::invalid_step};
    prepared_ = false;
    shares_ = graph_shares(*system_, static_cast<double>(h), options_.margin);
    ++renewals_;
    if (shares_.status != Status::ok) return fail_to_prepare({shares_.status});
    if (options_.dissipation == 1) shares_.make_all_implicit();
    const Report built = matrix_.build(*system_, shares_, options_.dissipation);
    if (!built) return fail_to_prepare(built);
    rows_.resize(matrix_.size(), System::Dim);
    if (matrix_.size() > 0) {
        solver_.analyzePattern(matrix_.matrix());
        solver_.factorize(matrix_.matrix());
        ++factorizations_;
        if (solver_.info() != Eigen::Success)
            return fail_to_prepare({Status::not_positive_definite});
    }
    prepared_ = true;
    return {};
}

template <class System, class Solver>
template <class AnyState>
Report GraphInertia<System, Solver>::step(AnyState& state, Scalar h, Index count) {
    const Report checked = integrator_detail::StepLoop<State>::check(*system_, state, h);
    if (!checked || count <= 0) return checked;
    if (const Report renewed = renew(h); !renewed) return renewed;
    const bool jumps = pins_jump(state, h);
    const auto correction = [&](const auto& a, const auto& v) { correct(a, v, h); };
    bool first = true;
    const Report report = steps_.run(
        *system_, state, h, count,
        [&](auto& sweep, int threads, const StepDamping&) {
            pins_jump_ = jumps;
            pin_work_ = 0;
            return sweep.run_corrected(*system_, state, h, count, threads, correction);
        },
        [&](State& own) {
            if (first) pin_work_ = 0;
            pins_jump_ = jumps && first;
            first = false;
            steps_.corrected_step(*system_, own, h, correction);
        });
    if (matrix_.holds_pins() && report) {
        last_.keep(*system_, state);
    } else {
        last_.forget();
    }
    return report;
}

template <class System, class Solver>
template <class Accelerations, class Velocities>
void GraphInertia<System, Solver>::correct(const Accelerations& a, const Velocities& v, Scalar h) {
    if (matrix_.size() == 0) return;
    const auto particle = [this](Index j) { return matrix_.particle(j); };
    for (Index j = 0; j < matrix_.size(); ++j) {
        rows_.row(j) = (system_->mass(particle(j)) * a(particle(j))).transpose();
    }
    matrix_.subtract_braking(v, rows_);
    const bool jump = std::exchange(pins_jump_, false);
    if (jump) {
        jump_.setZero(matrix_.size(), System::Dim);
        matrix_.subtract_pins(
            h, [&](Index i) { return Vector((v(i) - pins_seen().v.col(i)) / h); }, jump_);
        rows_ += jump_;
    }
    solution_ = solver_.solve(rows_);
    for (Index j = 0; j < matrix_.size(); ++j) {
        a.set(particle(j), solution_.row(j));
        if (!jump) continue;
        const Vector way = h * (v(particle(j)) + h / 2 * solution_.row(j).transpose());
        pin_work_ += static_cast<double>(jump_.row(j).dot(way));
    }
    pin_work_ += matrix_.braking_work(h, v, solution_);
}

/// Whether pins have changed their velocity since the last state: if they are about where they
/// were, for engines write positions, too.
template <class System, class Solver>
template <class AnyState>
bool GraphInertia<System, Solver>::pins_jump(const AnyState& state, Scalar h) const {
    const State& last = pins_seen();
    if (last.x.cols() != state.x.cols()) return false;
    bool jumps = false;
    for (Index i = 0; i < system_->size(); ++i) {
        if (!system_->is_pinned(i)) continue;
        const Vector x = state.x.col(i).template cast<Scalar>();
        const Vector v = state.v.col(i).template cast<Scalar>();
        const Scalar rounding = Scalar(1e-4) * (x.norm() + last.x.col(i).norm());
        const Scalar near = 2 * h * (v.norm() + last.v.col(i).norm()) + rounding;
        if (!((x - last.x.col(i)).norm() <= near)) return false;
        jumps = jumps || last.v.col(i) != v;
    }
    return jumps;
}

template <class System, class Solver>
auto GraphInertia<System, Solver>::response_to(const Points<Scalar, System::Dim>& impulse)
    -> Points<Scalar, System::Dim> {
    (void)renew();  // where that fails, nothing is touched
    Points<Scalar, System::Dim> dv = impulse * system_->inverse_mass().asDiagonal();
    if (matrix_.size() == 0) return dv;
    for (Index j = 0; j < matrix_.size(); ++j) {
        rows_.row(j) = impulse.col(matrix_.particle(j)).transpose();
    }
    solution_ = solver_.solve(rows_);
    for (Index j = 0; j < matrix_.size(); ++j) {
        dv.col(matrix_.particle(j)) = solution_.row(j).transpose();
    }
    return dv;
}

}  // namespace taut
